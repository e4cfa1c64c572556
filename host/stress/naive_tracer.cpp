// SPDX-License-Identifier: Apache-2.0
#include "host/stress/naive_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "host/flatten/triangle_list.h"
#include "host/parallel.h"
#include "host/processor_time.h"
#include "host/render/stopwatch.h"
#include "host/stress/naive_hierarchy.h"

namespace rt {

namespace {

template <typename T>
using Vec = glm::vec<3, T, glm::defaultp>;

template <typename T>
struct NaiveBall {
    Vec<T> center;
    T radius;
    int material;
};

template <typename T>
struct NaiveFace {
    Vec<T> corner, edge1, edge2, normal;
    std::array<Vec<T>, 3> normals;
    bool smooth;
    int material;
};

template <typename T>
struct NaiveMaterial {
    Vec<T> ambient, diffuse, specular, mirror;
    T shininess;
    bool two_sided;
};

template <typename T>
struct NaiveLamp {
    Vec<T> position, intensity;
};

template <typename T>
struct NaiveHit {
    T t = std::numeric_limits<T>::infinity();
    T u = 0, v = 0;
    const NaiveBall<T>* ball = nullptr;
    const NaiveFace<T>* face = nullptr;
};

/// Below, boxes do not pay.
constexpr std::size_t few_faces = 24;

template <typename T>
class NaiveTracer {
   public:
    NaiveTracer(const Scene& scene, NaiveStart start)
        : start_(start),
          background_(scene.background),
          ambient_light_(scene.ambient_light),
          max_bounces_(scene.max_bounces),
          width_(scene.width),
          height_(scene.height),
          grid_(scene.aa.count) {
        for (const auto& sphere : scene.spheres) {
            balls_.push_back({Vec<T>(sphere.center), T(sphere.radius), sphere.material});
        }
        const TriangleList triangles(scene);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            faces_.push_back(
                make_face({triangles.corners(i), triangles.normals(i), triangles.material(i)}));
        }
        if (faces_.size() >= few_faces) build_hierarchy();
        for (const auto& light : scene.lights) {
            lamps_.push_back({Vec<T>(light.position), Vec<T>(light.intensity)});
        }
        for (const auto& m : scene.materials) {
            materials_.push_back({Vec<T>(m.ambient), Vec<T>(m.diffuse), Vec<T>(m.specular),
                                  Vec<T>(m.mirror), T(m.shininess), m.two_sided});
        }
        set_camera(scene);
    }

    Vec<T> pixel(int x, int y) const {
        Vec<T> sum(0);
        for (int i = 0; i < grid_ * grid_; ++i) {
            const T px = T(x) + (T(i % grid_) + T(0.5)) / T(grid_);
            const T py = T(y) + (T(i / grid_) + T(0.5)) / T(grid_);
            sum += sample(px, py);
        }
        return sum / T(grid_ * grid_);
    }

   private:
    static NaiveFace<T> make_face(const Scene::Triangle& triangle) {
        NaiveFace<T> face{};
        face.corner = Vec<T>(triangle.vertices[0]);
        face.edge1 = Vec<T>(triangle.vertices[1]) - face.corner;
        face.edge2 = Vec<T>(triangle.vertices[2]) - face.corner;
        face.normal = glm::normalize(glm::cross(face.edge1, face.edge2));
        face.smooth = triangle.normals.has_value();
        for (std::size_t i = 0; face.smooth && i < 3; ++i) {
            face.normals[i] = Vec<T>((*triangle.normals)[i]);
        }
        face.material = triangle.material;
        return face;
    }

    void build_hierarchy() {
        std::vector<typename NaiveHierarchy<T>::Corners> corners;
        for (const auto& face : faces_) {
            corners.push_back({face.corner, face.corner + face.edge1, face.corner + face.edge2});
        }
        std::vector<std::size_t> order;
        hierarchy_.emplace(corners, order);
        std::vector<NaiveFace<T>> faces;
        for (const std::size_t i : order) faces.push_back(faces_[i]);
        faces_ = std::move(faces);
    }

    /// Calls visit(face) for those the ray may hit before `limit`, until a call returns true; that
    /// is returned.
    template <typename Visit>
    bool visit_faces(const Vec<T>& origin, const Vec<T>& dir, const T& limit,
                     const Visit& visit) const {
        if (!hierarchy_) return std::any_of(faces_.begin(), faces_.end(), visit);
        return hierarchy_->visit(origin, dir, limit,
                                 [&](std::size_t i) { return visit(faces_[i]); });
    }

    void set_camera(const Scene& scene) {
        const Scene::Camera& camera = scene.camera;
        const Scene::Window window = camera_window(camera, scene.width, scene.height);
        from_ = Vec<T>(camera.from);
        forward_ = glm::normalize(Vec<T>(camera.at) - from_);
        right_ = glm::normalize(glm::cross(forward_, Vec<T>(camera.up)));
        up_ = glm::cross(right_, forward_);
        left_ = T(window.left), bottom_ = T(window.bottom);
        window_width_ = T(window.right - window.left);
        window_height_ = T(window.top - window.bottom);
        orthographic_ = camera.projection == Scene::Projection::orthographic;
    }

    Vec<T> sample(T px, T py) const {
        const T x = left_ + window_width_ * px / T(width_);
        const T y = bottom_ + window_height_ * (T(height_) - py) / T(height_);
        const Vec<T> offset = x * right_ + y * up_;
        if (orthographic_) return trace(from_ + offset, forward_);
        return trace(from_, glm::normalize(forward_ + offset));
    }

    T least() const { return start_ == NaiveStart::least_distance ? T(1e-3) : T(0); }

    Vec<T> started(const Vec<T>& point, const Vec<T>& normal, const Vec<T>& dir) const {
        if (start_ == NaiveStart::least_distance) return point;
        return point + (glm::dot(normal, dir) < T(0) ? T(-1e-4) : T(1e-4)) * normal;
    }

    T hit_ball(const Vec<T>& origin, const Vec<T>& dir, const NaiveBall<T>& ball) const {
        const Vec<T> f = origin - ball.center;
        const T a = glm::dot(dir, dir);
        const T b = T(2) * glm::dot(f, dir);
        const T c = glm::dot(f, f) - ball.radius * ball.radius;
        const T discriminant = b * b - T(4) * a * c;
        if (discriminant < T(0)) return T(-1);
        const T root = std::sqrt(discriminant);
        const T near = (-b - root) / (T(2) * a);
        return near > least() ? near : (-b + root) / (T(2) * a);
    }

    static T hit_face(const Vec<T>& origin, const Vec<T>& dir, const NaiveFace<T>& face, T& u,
                      T& v) {
        const Vec<T> p = glm::cross(dir, face.edge2);
        const T determinant = glm::dot(face.edge1, p);
        if (std::fabs(determinant) < T(1e-8)) return T(-1);
        const T inverse = T(1) / determinant;
        const Vec<T> s = origin - face.corner;
        u = glm::dot(s, p) * inverse;
        if (u < T(0) || u > T(1)) return T(-1);
        const Vec<T> q = glm::cross(s, face.edge1);
        v = glm::dot(dir, q) * inverse;
        if (v < T(0) || u + v > T(1)) return T(-1);
        return glm::dot(face.edge2, q) * inverse;
    }

    NaiveHit<T> nearest(const Vec<T>& origin, const Vec<T>& dir) const {
        NaiveHit<T> best;
        for (const auto& ball : balls_) {
            const T t = hit_ball(origin, dir, ball);
            if (t > least() && t < best.t) best = {t, 0, 0, &ball, nullptr};
        }
        visit_faces(origin, dir, best.t, [&](const NaiveFace<T>& face) {
            T u = 0, v = 0;
            const T t = hit_face(origin, dir, face, u, v);
            if (t > least() && t < best.t) best = {t, u, v, nullptr, &face};
            return false;
        });
        return best;
    }

    bool blocked(const Vec<T>& origin, const Vec<T>& dir, T distance) const {
        for (const auto& ball : balls_) {
            const T t = hit_ball(origin, dir, ball);
            if (t > least() && t < distance) return true;
        }
        return visit_faces(origin, dir, distance, [&](const NaiveFace<T>& face) {
            T u, v;
            const T t = hit_face(origin, dir, face, u, v);
            return t > least() && t < distance;
        });
    }

    Vec<T> lit(const Vec<T>& point, const Vec<T>& normal, const Vec<T>& geometric,
               const Vec<T>& dir, const NaiveMaterial<T>& material) const {
        Vec<T> colour = material.ambient * ambient_light_;
        for (const auto& lamp : lamps_) {
            const Vec<T> way = lamp.position - point;
            const T distance = glm::length(way);
            const Vec<T> to_light = way / distance;
            const T cosine = glm::dot(normal, to_light);
            if (cosine <= T(0) || glm::dot(geometric, to_light) <= T(0)) continue;
            if (blocked(started(point, geometric, to_light), to_light, distance)) continue;
            const T lobe = glm::dot(normal, glm::normalize(to_light - dir));
            const T shine = lobe > T(0) ? std::pow(lobe, material.shininess) : T(0);
            colour += lamp.intensity * (cosine * material.diffuse + shine * material.specular);
        }
        return colour;
    }

    Vec<T> trace(Vec<T> origin, Vec<T> dir) const {
        Vec<T> colour(0), share(1);
        for (int bounce = 0;; ++bounce) {
            const NaiveHit<T> hit = nearest(origin, dir);
            if (!hit.ball && !hit.face) return colour + share * background_;
            const Vec<T> point = origin + hit.t * dir;
            Vec<T> geometric =
                hit.ball ? glm::normalize(point - hit.ball->center) : hit.face->normal;
            Vec<T> normal = geometric;
            if (hit.face && hit.face->smooth) {
                const auto& n = hit.face->normals;
                normal =
                    glm::normalize((T(1) - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2]);
                if (glm::dot(normal, geometric) < T(0)) geometric = -geometric;
            }
            const int index = hit.ball ? hit.ball->material : hit.face->material;
            const auto& material = materials_[static_cast<std::size_t>(index)];
            if (material.two_sided && glm::dot(geometric, dir) > T(0)) {
                normal = -normal;
                geometric = -geometric;
            }
            colour += share * lit(point, normal, geometric, dir, material);
            share *= material.mirror;
            if (bounce >= max_bounces_ || share == Vec<T>(0)) return colour;
            dir = glm::normalize(glm::reflect(dir, normal));
            origin = started(point, geometric, dir);
        }
    }

    const NaiveStart start_;
    const Vec<T> background_, ambient_light_;
    const int max_bounces_, width_, height_, grid_;
    std::vector<NaiveBall<T>> balls_;
    std::vector<NaiveFace<T>> faces_;
    std::optional<NaiveHierarchy<T>> hierarchy_;  ///< where there are many faces
    std::vector<NaiveMaterial<T>> materials_;
    std::vector<NaiveLamp<T>> lamps_;
    Vec<T> from_, forward_, right_, up_;
    T left_ = 0, bottom_ = 0, window_width_ = 0, window_height_ = 0;
    bool orthographic_ = false;
};

}  // namespace

template <typename T>
NaivePicture naive_picture(const Scene& scene, NaiveStart start, int threads) {
    const NaiveTracer<T> tracer(scene, start);
    NaivePicture result{{scene.width, scene.height, 3, {}}, 0, 0};
    const auto width = static_cast<std::size_t>(scene.width);
    result.picture.pixels.resize(3 * width * static_cast<std::size_t>(scene.height));
    const Stopwatch watch;
    const double start_seconds = processor_seconds();
    std::atomic<int> next_row = 0;
    run_on_threads(threads > 0 ? threads : available_cores(), [&](int) {
        for (int y = next_row++; y < scene.height; y = next_row++) {
            for (int x = 0; x < scene.width; ++x) {
                const Vec<T> colour = tracer.pixel(x, y);
                const std::size_t at =
                    3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
                for (std::size_t c = 0; c < 3; ++c) {
                    result.picture.pixels[at + c] = static_cast<float>(colour[static_cast<int>(c)]);
                }
            }
        }
    });
    result.seconds = watch.seconds();
    result.processor_seconds = processor_seconds() - start_seconds;
    return result;
}

template NaivePicture naive_picture<float>(const Scene&, NaiveStart, int);
template NaivePicture naive_picture<double>(const Scene&, NaiveStart, int);

}  // namespace rt
