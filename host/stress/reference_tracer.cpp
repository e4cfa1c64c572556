// SPDX-License-Identifier: Apache-2.0
#include "host/stress/reference_tracer.h"

#include <cmath>
#include <optional>
#include <vector>

#include "host/stress/wide_camera.h"
#include "host/stress/wide_real.h"
#include "host/stress/wide_shapes.h"

namespace rt {

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
constexpr R least_share = R(0x1p-53);

template <typename R>
struct WideLight {
    Wide3<R> position, intensity;
};

/// A ray, the weight of what it sees, and the number of bounces before it.
template <typename R>
struct Branch {
    WideRay<R> ray;
    Wide3<R> share{1, 1, 1};
    int bounce = 0;
};

template <typename R>
class Tracer final : public ReferenceTracer {
   public:
    explicit Tracer(const Scene& scene) : scene_(scene), camera_(scene) {
        for (const auto& sphere : scene.spheres) spheres_.push_back(stress::wide_sphere<R>(sphere));
        for (const auto& cone : scene.cones) frusta_.push_back(stress::wide_frustum<R>(cone));
        for (const auto& triangle : scene.triangles) {
            faces_.push_back(stress::wide_face<R>(triangle));
        }
        for (const auto& sphere : spheres_) balls_.push_back(stress::ball_of(sphere));
        for (const auto& frustum : frusta_) balls_.push_back(stress::ball_of(frustum));
        for (const auto& face : faces_) balls_.push_back(stress::ball_of(face));
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
        for (std::size_t prim = 0; prim < first_face(); ++prim) {
            const bool is_ball = prim < spheres_.size();
            const bool touches = is_ball ? stress::lies_on(eye, spheres_[prim])
                                         : stress::lies_on(eye, frusta_[prim - spheres_.size()]);
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
        } else if (prim < first_face()) {
            hit.t = stress::hit_frustum(ray, frusta_[prim - spheres_.size()], leaving);
        } else if (!leaving) {
            hit.t = stress::hit_face(ray, faces_[prim - first_face()], hit.u, hit.v);
        }
        if (hit.t > ray.least) hit.prim = static_cast<int>(prim);
        return hit;
    }

    std::size_t first_face() const { return spheres_.size() + frusta_.size(); }
    std::size_t primitives() const { return first_face() + faces_.size(); }

    /// Calls take(hit) for each primitive that the ray hits, until it returns true.
    template <typename Take>
    void for_each_hit(const WideRay<R>& ray, const Take& take) const {
        const Wide3<long double> dir = stress::narrowed(ray.dir);
        for (std::size_t prim = 0; prim < primitives(); ++prim) {
            const bool leaving = static_cast<int>(prim) == ray.from;
            if (!leaving && stress::passes_by(ray.origin, dir, balls_[prim])) continue;
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
        if (prim < first_face()) {
            return stress::frustum_surface(ray, hit.t, frusta_[prim - spheres_.size()]);
        }
        return stress::face_surface(hit, faces_[prim - first_face()]);
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
    static Wide3<R> saturated(const Wide3<R>& share) {
        const R most = 1e300;
        const auto cut = [&](R value) { return value < most ? value : most; };
        return {cut(share.x), cut(share.y), cut(share.z)};
    }

    static bool exceeds(const Wide3<R>& share, R least) {
        return share.x > least || share.y > least || share.z > least;
    }

    /// Pushes the branches that continue from a surface, the mirrored one last.
    static void branch(const Branch<R>& arriving, const WideRay<R>& start,
                       const WideSurface<R>& surface, const Scene::Material& material, bool inside,
                       std::vector<Branch<R>>& branches) {
        const Wide3<R>& dir = arriving.ray.dir;
        const int bounce = arriving.bounce + 1;
        Wide3<R> mirror = arriving.share * widened<R>(material.mirror);
        const Wide3<R> glass = arriving.share * widened<R>(material.transmission);
        const bool is_glass = exceeds(widened<R>(material.transmission), 0);
        const R least = is_glass ? least_share<R> : R(0);
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
            color = color + next.share * follow(next, branches);
        }
        return color;
    }

    const Scene scene_;
    const stress::WideCamera<R> camera_;
    std::vector<stress::WideSphere<R>> spheres_;
    std::vector<stress::WideFrustum<R>> frusta_;
    std::vector<stress::WideFace<R>> faces_;
    std::vector<stress::Ball<R>> balls_;  ///< around each primitive
    std::vector<WideLight<R>> lights_;
    int eye_surface_ = -1;
};

}  // namespace

std::unique_ptr<ReferenceTracer> make_reference_tracer(const Scene& scene, ReferenceKind kind) {
    if (kind == ReferenceKind::extended) return std::make_unique<Tracer<long double>>(scene);
    return std::make_unique<Tracer<stress::Quad>>(scene);
}

}  // namespace rt
