// SPDX-License-Identifier: Apache-2.0
#include "host/stress/reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/base/parallel.h"
#include "host/stress/wide_real.h"
#include "host/stress/wide_shapes.h"

namespace rt {

namespace stress {

/// The scene's camera for the reference, in wide reals.
template <typename R>
class WideCamera {
   public:
    explicit WideCamera(const Scene& scene)
        : width_(scene.width),
          height_(scene.height),
          parallel_(scene.camera.projection == Scene::Projection::orthographic) {
        const Scene::Camera& camera = scene.camera;
        from_ = widened<R>(camera.from);
        forward_ = unit(widened<R>(camera.at) - from_);
        right_ = unit(cross(forward_, widened<R>(camera.up)));
        up_ = cross(right_, forward_);
        set_window(camera);
    }

    /// The ray through the point (x, y) of the picture, in pixels from its top left corner.
    WideRay<R> eye_ray(R x, R y) const {
        const R across = left_ + (right_side_ - left_) * x / width_;
        const R upwards = top_ - (top_ - bottom_) * y / height_;
        const Wide3<R> offset = across * right_ + upwards * up_;
        if (parallel_) return {from_ + offset, forward_};
        return {from_, unit(forward_ + offset)};
    }

    /// Whether all eye rays start at `from`.
    bool has_one_eye() const { return !parallel_; }

   private:
    /// The window's sides; a field of view gives square pixels.
    void set_window(const Scene::Camera& camera) {
        using Fixed = Scene::FieldOfView::Fixed;
        const auto [fixed, amount] = camera.field_of_view;
        if (fixed == Fixed::window) {
            left_ = camera.window.left, right_side_ = camera.window.right;
            bottom_ = camera.window.bottom, top_ = camera.window.top;
            return;
        }
        const bool is_angle = fixed == Fixed::horizontal || fixed == Fixed::vertical;
        const bool is_width = fixed == Fixed::horizontal || fixed == Fixed::view_width;
        const long double angle = amount * (std::numbers::pi_v<long double> / 360);
        const R half = is_angle ? R(std::tan(angle)) : R(amount) / 2;
        right_side_ = is_width ? half : half * width_ / height_;
        top_ = is_width ? half * height_ / width_ : half;
        left_ = -right_side_, bottom_ = -top_;
    }

    R width_, height_;
    bool parallel_;
    Wide3<R> from_, forward_, right_, up_;
    R left_ = -1, right_side_ = 1, bottom_ = -1, top_ = 1;
};

}  // namespace stress

namespace {

using stress::Wide3;
using stress::WideHit;
using stress::widened;
using stress::WideRay;
using stress::WideSurface;

/// Surfaces this close together, relative to the distance, count as one. Far above the rounding of
/// either wide type.
template <typename R>
constexpr R same_distance = R(1e-12);

/// At glass, branches that count for less than half an ulp of white in double are dropped.
template <typename R>
constexpr R least_throughput = R(0x1p-53);

template <typename R>
struct WideLight {
    Wide3<R> position, intensity;
};

/// A ray, the weight of what it sees, and the number of bounces before it.
template <typename R>
struct Branch {
    WideRay<R> ray;
    Wide3<R> throughput{1, 1, 1};
    int bounce = 0;
};

template <typename R>
class Tracer final : public ReferenceTracer {
   public:
    explicit Tracer(const Scene& scene) : scene_(scene), camera_(scene) {
        for (const auto& sphere : scene.spheres) spheres_.push_back(stress::wide_sphere<R>(sphere));
        for (const auto& cone : scene.cones) cones_.push_back(stress::wide_cone<R>(cone));
        for (const auto& triangle : scene.triangles) {
            triangles_.push_back(stress::wide_triangle<R>(triangle));
        }
        for (const auto& sphere : spheres_) bounds_.push_back(stress::bound_of(sphere));
        for (const auto& cone : cones_) bounds_.push_back(stress::bound_of(cone));
        for (const auto& triangle : triangles_) bounds_.push_back(stress::bound_of(triangle));
        for (const auto& light : scene.lights) {
            lights_.push_back({widened<R>(light.position), widened<R>(light.intensity)});
        }
        if (camera_.has_one_eye()) eye_surface_ = surface_at_eye();
    }

    std::array<double, 3> color_at(double x, double y, double dx, double dy) const override {
        WideRay<R> ray = camera_.eye_ray(R(x) + R(dx), R(y) + R(dy));
        ray.from = eye_surface_;
        const Wide3<R> color = trace(ray);
        return {static_cast<double>(color.x), static_cast<double>(color.y),
                static_cast<double>(color.z)};
    }

   private:
    /// The sphere or cone on whose surface the eye lies, to the last bits of a double, or -1. Eye
    /// rays leave it.
    int surface_at_eye() const {
        const Wide3<R> eye = widened<R>(scene_.camera.from);
        for (std::size_t prim = 0; prim < first_triangle(); ++prim) {
            const bool is_sphere = prim < spheres_.size();
            const bool touches = is_sphere ? stress::lies_on(eye, spheres_[prim])
                                           : stress::lies_on(eye, cones_[prim - spheres_.size()]);
            if (touches) return static_cast<int>(prim);
        }
        return -1;
    }

    /// Spheres come first, then cones, then triangles.
    WideHit<R> hit_primitive(const WideRay<R>& ray, std::size_t prim) const {
        WideHit<R> hit;
        const bool leaving = static_cast<int>(prim) == ray.from;
        if (prim < spheres_.size()) {
            hit.t = stress::hit_sphere(ray, spheres_[prim], leaving);
        } else if (prim < first_triangle()) {
            hit.t = stress::hit_cone(ray, cones_[prim - spheres_.size()], leaving);
        } else if (!leaving) {
            hit.t = stress::hit_triangle(ray, triangles_[prim - first_triangle()], hit.u, hit.v);
        }
        if (hit.t > ray.least) hit.prim = static_cast<int>(prim);
        return hit;
    }

    std::size_t first_triangle() const { return spheres_.size() + cones_.size(); }
    std::size_t primitives() const { return first_triangle() + triangles_.size(); }

    /// Calls take(hit) for each primitive that the ray hits, until it returns true.
    template <typename Take>
    void for_each_hit(const WideRay<R>& ray, const Take& take) const {
        const Wide3<long double> dir = stress::narrowed(ray.dir);
        for (std::size_t prim = 0; prim < primitives(); ++prim) {
            const bool leaving = static_cast<int>(prim) == ray.from;
            if (!leaving && stress::passes_by(ray.origin, dir, bounds_[prim])) continue;
            const WideHit<R> hit = hit_primitive(ray, prim);
            if (hit.prim >= 0 && take(hit)) return;
        }
    }

    WideHit<R> nearest(const WideRay<R>& ray) const {
        WideHit<R> best;
        for_each_hit(ray, [&](const WideHit<R>& hit) {
            if (best.prim < 0 || hit.t < best.t * (1 - same_distance<R>)) best = hit;
            return false;
        });
        return best;
    }

    bool blocked(const WideRay<R>& ray, R distance) const {
        bool found = false;
        for_each_hit(ray, [&](const WideHit<R>& hit) {
            return found = hit.t < distance * (1 - same_distance<R>);
        });
        return found;
    }

    WideSurface<R> surface_of(const WideRay<R>& ray, const WideHit<R>& hit) const {
        const auto prim = static_cast<std::size_t>(hit.prim);
        if (prim < spheres_.size()) return stress::sphere_surface(ray, hit.t, spheres_[prim]);
        if (prim < first_triangle()) {
            return stress::cone_surface(ray, hit.t, cones_[prim - spheres_.size()]);
        }
        return stress::triangle_surface(hit, triangles_[prim - first_triangle()]);
    }

    static R lobe(const Wide3<R>& normal, const Wide3<R>& half_vector, double exponent) {
        if (exponent == 0) return 1;
        const R cosine = dot(normal, half_vector);
        if (!(cosine > 0)) return 0;
        const auto gap = static_cast<long double>(1 - cosine);
        const long double log_cosine = gap < 0.5L ? std::log1p(-gap) : std::log(1 - gap);
        return std::exp(exponent * log_cosine);
    }

    Wide3<R> lit_by(const WideLight<R>& light, const WideSurface<R>& surface,
                    const Scene::Material& material, const Wide3<R>& to_eye,
                    const WideRay<R>& shadow_start) const {
        const Wide3<R> way = light.position - surface.point;
        if (!(dot(surface.geometric, way) > 0)) return {};
        const R distance = length(way);
        WideRay<R> shadow = shadow_start;
        shadow.dir = (R(1) / distance) * way;
        const R cosine = dot(surface.normal, shadow.dir);
        if (!(cosine > 0) || blocked(shadow, distance)) return {};
        const Wide3<R> sum = shadow.dir + to_eye;
        Wide3<R> reflected = cosine * widened<R>(material.diffuse);
        if (dot(sum, sum) > 0) {
            reflected = reflected + lobe(surface.normal, unit(sum), material.shininess) *
                                        widened<R>(material.specular);
        }
        return light.intensity * reflected;
    }

    static Wide3<R> mirrored(const Wide3<R>& dir, const WideSurface<R>& surface) {
        const auto about = [&](const Wide3<R>& normal) {
            return dir - (2 * dot(dir, normal)) * normal;
        };
        const Wide3<R> out = about(surface.normal);
        const bool leaves = dot(out, surface.geometric) * dot(dir, surface.geometric) < 0;
        return unit(leaves ? out : about(surface.geometric));
    }

    /// Snell's law, `eta` the index in front of the surface over that behind it; empty for total
    /// reflection. Falls back to the face normal where an interpolated one would block the ray.
    static std::optional<Wide3<R>> refracted(const Wide3<R>& dir, const WideSurface<R>& surface,
                                             R eta) {
        for (const Wide3<R>& outwards : {surface.normal, surface.geometric}) {
            const Wide3<R> normal = dot(dir, outwards) < 0 ? outwards : -outwards;
            const R cosine = -dot(dir, normal);
            const R squared = 1 - eta * eta * (1 - cosine * cosine);
            if (squared < 0) return std::nullopt;
            const Wide3<R> through =
                unit(eta * dir + (eta * cosine - stress::square_root(squared)) * normal);
            if (dot(through, surface.geometric) * dot(dir, surface.geometric) > 0) return through;
        }
        return std::nullopt;
    }

    /// Keeps mirrors that brighten at each bounce finite, far above anything visible.
    static Wide3<R> saturated(const Wide3<R>& throughput) {
        const R most = 1e300;
        const auto cut = [&](R value) { return value < most ? value : most; };
        return {cut(throughput.x), cut(throughput.y), cut(throughput.z)};
    }

    static bool exceeds(const Wide3<R>& throughput, R least) {
        return throughput.x > least || throughput.y > least || throughput.z > least;
    }

    /// Pushes the branches that continue from a surface, the mirrored one last.
    static void branch(const Branch<R>& arriving, const WideRay<R>& start,
                       const WideSurface<R>& surface, const Scene::Material& material, bool inside,
                       std::vector<Branch<R>>& branches) {
        const Wide3<R>& dir = arriving.ray.dir;
        const int bounce = arriving.bounce + 1;
        Wide3<R> mirror = arriving.throughput * widened<R>(material.mirror);
        const Wide3<R> glass = arriving.throughput * widened<R>(material.transmission);
        const bool is_glass = exceeds(widened<R>(material.transmission), 0);
        const R least = is_glass ? least_throughput<R> : R(0);
        if (is_glass) {
            const R eta = inside ? R(material.ior) : 1 / R(material.ior);
            const auto through = refracted(dir, surface, eta);
            if (!through) {
                mirror = mirror + glass;
            } else if (exceeds(glass, least)) {
                branches.push_back({start, saturated(glass), bounce});
                branches.back().ray.dir = *through;
            }
        }
        if (!exceeds(mirror, least)) return;
        branches.push_back({start, saturated(mirror), bounce});
        branches.back().ray.dir = mirrored(dir, surface);
    }

    /// What the branch's ray sees directly; pushes the branches that continue from there.
    Wide3<R> follow(const Branch<R>& arriving, std::vector<Branch<R>>& branches) const {
        const WideRay<R>& ray = arriving.ray;
        const WideHit<R> hit = nearest(ray);
        if (hit.prim < 0) return widened<R>(scene_.background);
        WideSurface<R> surface = surface_of(ray, hit);
        const auto& material = scene_.materials[static_cast<std::size_t>(surface.material)];
        const bool inside = dot(surface.geometric, ray.dir) > 0;
        if (material.two_sided && inside) {
            surface.normal = -surface.normal;
            surface.geometric = -surface.geometric;
        }
        const WideRay<R> start{surface.point, {}, hit.prim, same_distance<R> / 16 * hit.t};
        Wide3<R> here = widened<R>(material.ambient) * widened<R>(scene_.ambient_light);
        for (const WideLight<R>& light : lights_) {
            here = here + lit_by(light, surface, material, -ray.dir, start);
        }
        if (arriving.bounce < scene_.max_bounces) {
            branch(arriving, start, surface, material, inside, branches);
        }
        return here;
    }

    Wide3<R> trace(const WideRay<R>& eye_ray) const {
        Wide3<R> color;
        std::vector<Branch<R>> branches{{eye_ray}};
        while (!branches.empty()) {
            const Branch<R> next = branches.back();
            branches.pop_back();
            color = color + next.throughput * follow(next, branches);
        }
        return color;
    }

    const Scene scene_;
    const stress::WideCamera<R> camera_;
    std::vector<stress::WideSphere<R>> spheres_;
    std::vector<stress::WideCone<R>> cones_;
    std::vector<stress::WideTriangle<R>> triangles_;
    std::vector<stress::Bound<R>> bounds_;  ///< around each primitive
    std::vector<WideLight<R>> lights_;
    int eye_surface_ = -1;
};

constexpr double nearby = 0.02;  // pixels
constexpr double least_change = 0.5 / 255;
constexpr std::size_t pixel_run = 16;

/// The eight moves of a sample: along the axes and the diagonals.
constexpr double diagonal = 0.70710678 * nearby;
constexpr std::array<std::array<double, 2>, 8> moves{{{nearby, 0},
                                                      {-nearby, 0},
                                                      {0, nearby},
                                                      {0, -nearby},
                                                      {diagonal, diagonal},
                                                      {-diagonal, diagonal},
                                                      {diagonal, -diagonal},
                                                      {-diagonal, -diagonal}}};

bool differ(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double change = std::clamp(a[c], 0.0, 1.0) - std::clamp(b[c], 0.0, 1.0);
        if (!(std::fabs(change) <= least_change)) return true;
    }
    return false;
}

}  // namespace

std::unique_ptr<ReferenceTracer> make_reference_tracer(const Scene& scene, ReferenceKind kind) {
    if (kind == ReferenceKind::extended) return std::make_unique<Tracer<long double>>(scene);
    return std::make_unique<Tracer<stress::Quad>>(scene);
}

ReferencePicture::ReferencePicture(const Scene& scene, ReferenceKind kind)
    : width_(scene.width),
      height_(scene.height),
      grid_(scene.aa.count),
      tracer_(make_reference_tracer(scene, kind)),
      colors_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      edges_(colors_.size(), -1) {
    for_each_run(colors_.size(), pixel_run, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) colors_[i] = pixel_color(i, 0, 0);
                 });
}

std::array<double, 3> ReferencePicture::pixel_color(std::size_t pixel, double dx, double dy) const {
    const auto width = static_cast<std::size_t>(width_);
    std::array<double, 3> sum{};
    for (int i = 0; i < grid_ * grid_; ++i) {
        const double x = static_cast<double>(pixel % width) + (i % grid_ + 0.5) / grid_;
        const double y = static_cast<double>(pixel / width) + (i / grid_ + 0.5) / grid_;
        const std::array<double, 3> color = tracer_->color_at(x, y, dx, dy);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c] / (grid_ * grid_);
    }
    return sum;
}

bool ReferencePicture::changes_nearby(std::size_t pixel) const {
    return std::any_of(moves.begin(), moves.end(), [&](const std::array<double, 2>& move) {
        return differ(colors_[pixel], pixel_color(pixel, move[0], move[1]));
    });
}

std::vector<bool> ReferencePicture::at_edges(std::span<const std::size_t> pixels) {
    for_each_run(pixels.size(), pixel_run, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) {
                         std::int8_t& edge = edges_[pixels[i]];
                         if (edge < 0) edge = changes_nearby(pixels[i]) ? 1 : 0;
                     }
                 });
    std::vector<bool> answer;
    for (const std::size_t pixel : pixels) answer.push_back(edges_[pixel] == 1);
    return answer;
}

Picture ReferencePicture::as_picture() const {
    Picture picture{width_, height_, 3, {}};
    for (const auto& color : colors_) {
        for (const double value : color) picture.pixels.push_back(static_cast<float>(value));
    }
    return picture;
}

}  // namespace rt
