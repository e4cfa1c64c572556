// SPDX-License-Identifier: Apache-2.0
#include "host/stress/naive_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "host/flatten/triangle_list.h"
#include "host/parallel.h"
#include "host/processor_time.h"
#include "host/render/stopwatch.h"
#include "host/stress/naive_hierarchy.h"
#include "host/stress/naive_shapes.h"

namespace rt {

namespace {

using naive::Vec;

template <typename T>
struct NaiveMaterial {
    Vec<T> ambient, diffuse, specular, mirror, transmission;
    T shininess, ior;
    bool two_sided;
};

template <typename T>
struct NaiveLight {
    Vec<T> position, intensity;
};

template <typename T>
struct NaiveHit {
    T t = std::numeric_limits<T>::infinity();
    T u = 0, v = 0;
    const naive::Sphere<T>* sphere = nullptr;
    const naive::Cone<T>* cone = nullptr;
    const naive::Face<T>* face = nullptr;
};

template <typename T>
struct NaiveBranch {
    Vec<T> origin, dir, share;
    int bounce;
};

/// Pending rays: at most one per bounce, and scenes that branch have few bounces.
template <typename T>
struct NaiveStack {
    std::array<NaiveBranch<T>, 64> branches;
    std::size_t size = 0;

    void push(const NaiveBranch<T>& branch) {
        if (size < branches.size()) branches[size++] = branch;
    }
};

/// Below this count, a BVH does not pay off.
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
        for (const auto& sphere : scene.spheres) spheres_.push_back(naive::make_sphere<T>(sphere));
        for (const auto& cone : scene.cones) cones_.push_back(naive::make_cone<T>(cone));
        const TriangleList triangles(scene);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            faces_.push_back(naive::make_face<T>(
                {triangles.corners(i), triangles.normals(i), triangles.material(i)}));
        }
        if (faces_.size() >= few_faces) build_hierarchy();
        for (const auto& light : scene.lights) {
            lights_.push_back({Vec<T>(light.position), Vec<T>(light.intensity)});
        }
        for (const auto& m : scene.materials) {
            materials_.push_back({Vec<T>(m.ambient), Vec<T>(m.diffuse), Vec<T>(m.specular),
                                  Vec<T>(m.mirror), Vec<T>(m.transmission), T(m.shininess),
                                  T(m.ior), m.two_sided});
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
    void build_hierarchy() {
        std::vector<typename NaiveHierarchy<T>::Corners> corners;
        for (const auto& face : faces_) {
            corners.push_back({face.corner, face.corner + face.edge1, face.corner + face.edge2});
        }
        std::vector<std::size_t> order;
        hierarchy_.emplace(corners, order);
        std::vector<naive::Face<T>> faces;
        for (const std::size_t i : order) faces.push_back(faces_[i]);
        faces_ = std::move(faces);
    }

    /// Calls visit(face) for the faces that the ray may hit before `limit`, until a call returns
    /// true. Returns whether one did.
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

    NaiveHit<T> nearest(const Vec<T>& origin, const Vec<T>& dir) const {
        NaiveHit<T> best;
        for (const auto& sphere : spheres_) {
            const T t = naive::hit_sphere(origin, dir, sphere, least());
            if (t > least() && t < best.t) best = {t, 0, 0, &sphere, nullptr, nullptr};
        }
        for (const auto& cone : cones_) {
            const T t = naive::hit_cone(origin, dir, cone, least());
            if (t > least() && t < best.t) best = {t, 0, 0, nullptr, &cone, nullptr};
        }
        visit_faces(origin, dir, best.t, [&](const naive::Face<T>& face) {
            T u = 0, v = 0;
            const T t = naive::hit_face(origin, dir, face, u, v);
            if (t > least() && t < best.t) best = {t, u, v, nullptr, nullptr, &face};
            return false;
        });
        return best;
    }

    bool blocked(const Vec<T>& origin, const Vec<T>& dir, T distance) const {
        const auto stops = [&](T t) { return t > least() && t < distance; };
        for (const auto& sphere : spheres_) {
            if (stops(naive::hit_sphere(origin, dir, sphere, least()))) return true;
        }
        for (const auto& cone : cones_) {
            if (stops(naive::hit_cone(origin, dir, cone, least()))) return true;
        }
        return visit_faces(origin, dir, distance, [&](const naive::Face<T>& face) {
            T u, v;
            return stops(naive::hit_face(origin, dir, face, u, v));
        });
    }

    naive::Surface<T> surface_of(const NaiveHit<T>& hit, const Vec<T>& point) const {
        if (hit.cone) return naive::cone_surface(point, *hit.cone);
        if (hit.face) return naive::face_surface(*hit.face, hit.u, hit.v);
        const Vec<T> normal = glm::normalize(point - hit.sphere->center);
        return {normal, normal, hit.sphere->material};
    }

    Vec<T> lit(const Vec<T>& point, const Vec<T>& normal, const Vec<T>& geometric,
               const Vec<T>& dir, const NaiveMaterial<T>& material) const {
        Vec<T> color = material.ambient * ambient_light_;
        for (const auto& light : lights_) {
            const Vec<T> way = light.position - point;
            const T distance = glm::length(way);
            const Vec<T> to_light = way / distance;
            const T cosine = glm::dot(normal, to_light);
            if (cosine <= T(0) || glm::dot(geometric, to_light) <= T(0)) continue;
            if (blocked(started(point, geometric, to_light), to_light, distance)) continue;
            const T lobe = glm::dot(normal, glm::normalize(to_light - dir));
            const T shine = lobe > T(0) ? std::pow(lobe, material.shininess) : T(0);
            color += light.intensity * (cosine * material.diffuse + shine * material.specular);
        }
        return color;
    }

    /// Snell's law; false for total reflection.
    static bool refract(const Vec<T>& dir, const Vec<T>& normal, T eta, Vec<T>& through) {
        const T cosine = -glm::dot(dir, normal);
        const T squared = T(1) - eta * eta * (T(1) - cosine * cosine);
        if (squared < T(0)) return false;
        through = glm::normalize(eta * dir + (eta * cosine - std::sqrt(squared)) * normal);
        return true;
    }

    void branch(const NaiveBranch<T>& from, const Vec<T>& point, const naive::Surface<T>& surface,
                const NaiveMaterial<T>& material, bool inside, NaiveStack<T>& branches) const {
        Vec<T> mirror = from.share * material.mirror, through;
        const Vec<T> glass = from.share * material.transmission;
        const auto push = [&](const Vec<T>& dir, const Vec<T>& share) {
            branches.push({started(point, surface.geometric, dir), dir, share, from.bounce + 1});
        };
        if (material.transmission != Vec<T>(0)) {
            const bool turned = glm::dot(surface.normal, from.dir) > T(0);
            const Vec<T> normal = turned ? -surface.normal : surface.normal;
            if (refract(from.dir, normal, inside ? material.ior : T(1) / material.ior, through)) {
                if (glm::any(glm::greaterThan(glass, Vec<T>(1e-12)))) push(through, glass);
            } else {
                mirror += glass;
            }
            if (!glm::any(glm::greaterThan(mirror, Vec<T>(1e-12)))) return;
        }
        if (mirror == Vec<T>(0)) return;
        push(glm::normalize(glm::reflect(from.dir, surface.normal)), mirror);
    }

    Vec<T> follow(const NaiveBranch<T>& from, NaiveStack<T>& branches) const {
        const NaiveHit<T> hit = nearest(from.origin, from.dir);
        if (!hit.sphere && !hit.cone && !hit.face) return background_;
        const Vec<T> point = from.origin + hit.t * from.dir;
        naive::Surface<T> surface = surface_of(hit, point);
        const auto& material = materials_[static_cast<std::size_t>(surface.material)];
        const bool inside = glm::dot(surface.geometric, from.dir) > T(0);
        if (material.two_sided && inside) {
            surface.normal = -surface.normal;
            surface.geometric = -surface.geometric;
        }
        if (from.bounce < max_bounces_) branch(from, point, surface, material, inside, branches);
        return lit(point, surface.normal, surface.geometric, from.dir, material);
    }

    Vec<T> trace(const Vec<T>& origin, const Vec<T>& dir) const {
        Vec<T> color(0);
        NaiveStack<T> branches;
        branches.push({origin, dir, Vec<T>(1), 0});
        while (branches.size > 0) {
            const NaiveBranch<T> next = branches.branches[--branches.size];
            color += next.share * follow(next, branches);
        }
        return color;
    }

    const NaiveStart start_;
    const Vec<T> background_, ambient_light_;
    const int max_bounces_, width_, height_, grid_;
    std::vector<naive::Sphere<T>> spheres_;
    std::vector<naive::Cone<T>> cones_;
    std::vector<naive::Face<T>> faces_;
    std::optional<NaiveHierarchy<T>> hierarchy_;  ///< if there are many faces
    std::vector<NaiveMaterial<T>> materials_;
    std::vector<NaiveLight<T>> lights_;
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
                const Vec<T> color = tracer.pixel(x, y);
                const std::size_t at =
                    3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
                for (std::size_t c = 0; c < 3; ++c) {
                    result.picture.pixels[at + c] = static_cast<float>(color[static_cast<int>(c)]);
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
