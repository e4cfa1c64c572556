// SPDX-License-Identifier: Apache-2.0
#include "host/stress/reference.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "host/base/parallel.h"
#include "host/stress/wide_shapes.h"

namespace rt {

namespace stress {

namespace {

/// The scene's camera for the reference, in wide reals.
template <typename R>
class WideCamera {
   public:
    explicit WideCamera(const Scene& scene)
        : width_(scene.width),
          height_(scene.height),
          parallel_(scene.camera.projection == Scene::Projection::orthographic) {
        const Scene::Camera& camera = scene.camera;
        from_ = Wide3<R>(camera.from);
        forward_ = unit(Wide3<R>(camera.at) - from_);
        right_ = unit(cross(forward_, Wide3<R>(camera.up)));
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

/// A ReferenceTracer.
template <typename R>
class Tracer {
   public:
    explicit Tracer(const Scene& scene) : scene_(scene), camera_(scene) {
        for (const auto& sphere : scene.spheres) add(wide_sphere<R>(sphere));
        for (const auto& cone : scene.cones) add(wide_cone<R>(cone));
        for (const auto& triangle : scene.triangles) add(wide_triangle<R>(triangle));
        for (const auto& light : scene.lights) {
            lights_.push_back({Wide3<R>(light.position), Wide3<R>(light.intensity)});
        }
        if (camera_.has_one_eye()) eye_surface_ = surface_at_eye();
    }

    glm::dvec3 operator()(double x, double y, double dx, double dy) const {
        WideRay<R> ray = camera_.eye_ray(R(x) + R(dx), R(y) + R(dy));
        ray.from = eye_surface_;
        return glm::dvec3(trace(ray));
    }

   private:
    template <typename Shape>
    void add(const Shape& shape) {
        shapes_.emplace_back(shape);
        bounds_.push_back(bound_of(shape));
    }

    /// The shape on whose surface the eye lies, to the last bits of a double, or -1. Eye rays
    /// leave it.
    int surface_at_eye() const {
        const Wide3<R> eye(scene_.camera.from);
        const auto found = std::ranges::find_if(shapes_, [&](const WideShape<R>& any) {
            return std::visit([&](const auto& shape) { return lies_on(eye, shape); }, any);
        });
        return found == shapes_.end() ? -1 : static_cast<int>(found - shapes_.begin());
    }

    /// Calls take(hit) for each shape that the ray hits, until it returns true.
    template <typename Take>
    void for_each_hit(const WideRay<R>& ray, const Take& take) const {
        const Wide3<long double> dir(ray.dir);
        for (std::size_t i = 0; i < shapes_.size(); ++i) {
            const bool leaving = static_cast<int>(i) == ray.from;
            if (!leaving && passes_by(ray.origin, dir, bounds_[i])) continue;
            WideHit<R> hit = std::visit(
                [&](const auto& shape) { return hit_shape(ray, shape, leaving); }, shapes_[i]);
            hit.prim = static_cast<int>(i);
            if (hit.t > ray.least && take(hit)) return;
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
        return std::visit([&](const auto& shape) { return surface_at(ray, hit, shape); },
                          shapes_[static_cast<std::size_t>(hit.prim)]);
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
        Wide3<R> reflected = cosine * Wide3<R>(material.diffuse);
        if (dot(sum, sum) > 0) {
            reflected = reflected + lobe(surface.normal, unit(sum), material.shininess) *
                                        Wide3<R>(material.specular);
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
                unit(eta * dir + (eta * cosine - square_root(squared)) * normal);
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
        Wide3<R> mirror = arriving.throughput * Wide3<R>(material.mirror);
        const Wide3<R> glass = arriving.throughput * Wide3<R>(material.transmission);
        const bool is_glass = exceeds(Wide3<R>(material.transmission), 0);
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
        if (hit.prim < 0) return Wide3<R>(scene_.background);
        WideSurface<R> surface = surface_of(ray, hit);
        const auto& material = scene_.materials[static_cast<std::size_t>(surface.material)];
        const bool inside = dot(surface.geometric, ray.dir) > 0;
        if (material.two_sided && inside) {
            surface.normal = -surface.normal;
            surface.geometric = -surface.geometric;
        }
        const WideRay<R> start{surface.point, {}, hit.prim, same_distance<R> / 16 * hit.t};
        Wide3<R> here = Wide3<R>(material.ambient) * Wide3<R>(scene_.ambient_light);
        for (const WideLight<R>& light : lights_) {
            here = here + lit_by(light, surface, material, -ray.dir, start);
        }
        if (arriving.bounce < scene_.max_bounces) {
            branch(arriving, start, surface, material, inside, branches);
        }
        return here;
    }

    Wide3<R> trace(const WideRay<R>& eye_ray) const {
        Wide3<R> color(0);
        std::vector<Branch<R>> branches{{eye_ray}};
        while (!branches.empty()) {
            const Branch<R> next = branches.back();
            branches.pop_back();
            color = color + next.throughput * follow(next, branches);
        }
        return color;
    }

    const Scene scene_;
    const WideCamera<R> camera_;
    std::vector<WideShape<R>> shapes_;  ///< spheres, then cones, then triangles
    std::vector<Bound<R>> bounds_;      ///< around each
    std::vector<WideLight<R>> lights_;
    int eye_surface_ = -1;
};

constexpr double nearby = 0.02;  // pixels
constexpr double least_change = 0.5 / 255;

/// The eight moves of a sample: along the axes and the diagonals.
constexpr double diagonal = 0.70710678 * nearby;
constexpr glm::dvec2 moves[] = {{nearby, 0},           {-nearby, 0},          {0, nearby},
                                {0, -nearby},          {diagonal, diagonal},  {-diagonal, diagonal},
                                {diagonal, -diagonal}, {-diagonal, -diagonal}};

}  // namespace

}  // namespace stress

double color_difference(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 change = glm::abs(glm::clamp(a, 0.0, 1.0) - glm::clamp(b, 0.0, 1.0));
    return std::isnan(change.x + change.y + change.z) ? std::numeric_limits<double>::infinity()
                                                      : std::max({change.x, change.y, change.z});
}

ReferenceTracer make_reference_tracer(const Scene& scene, ReferenceKind kind) {
    if (kind == ReferenceKind::extended) return stress::Tracer<long double>(scene);
    return stress::Tracer<stress::Quad>(scene);
}

ReferencePicture::ReferencePicture(const Scene& scene, ReferenceKind kind)
    : width_(scene.width),
      height_(scene.height),
      grid_(scene.aa.count),
      tracer_(make_reference_tracer(scene, kind)),
      colors_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      edges_(colors_.size(), -1) {
    for_each_run(colors_.size(), 16, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) colors_[i] = pixel_color(i, {0, 0});
    });
}

glm::dvec3 ReferencePicture::pixel_color(std::size_t pixel, glm::dvec2 move) const {
    const auto width = static_cast<std::size_t>(width_);
    glm::dvec3 sum(0);
    for (int i = 0; i < grid_ * grid_; ++i) {
        const double x = static_cast<double>(pixel % width) + (i % grid_ + 0.5) / grid_;
        const double y = static_cast<double>(pixel / width) + (i / grid_ + 0.5) / grid_;
        sum += tracer_(x, y, move.x, move.y) / static_cast<double>(grid_ * grid_);
    }
    return sum;
}

bool ReferencePicture::is_at_edge(std::size_t pixel) {
    const auto changes = [&](glm::dvec2 move) {
        return color_difference(colors_[pixel], pixel_color(pixel, move)) > stress::least_change;
    };
    std::int8_t& edge = edges_[pixel];
    if (edge < 0) edge = std::ranges::any_of(stress::moves, changes) ? 1 : 0;
    return edge == 1;
}

Picture ReferencePicture::as_picture() const {
    Picture picture{width_, height_, 3, {}};
    for (const glm::dvec3& color : colors_) {
        for (const double value : {color.x, color.y, color.z}) {
            picture.pixels.push_back(static_cast<float>(value));
        }
    }
    return picture;
}

}  // namespace rt
