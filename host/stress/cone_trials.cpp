// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_scene.h"
#include "host/stress/ray_dice.h"
#include "host/stress/ray_trials.h"
#include "host/stress/wide_shapes.h"
#include "host/trace/whitted.h"

namespace rt {

namespace {

using stress::Quad;
using stress::Wide3;

/// The rounded cone that the tracer sees.
template <typename T>
stress::WideFrustum<Quad> exact_frustum(const typename Flat<T>::Cone& cone) {
    return {in_quad(cone.base),     unit(in_quad(cone.axis)), Quad(cone.length),
            Quad(cone.base_radius), Quad(cone.slope),         0};
}

/// A direction at random past the cone: to a point within 1.5 times its extent.
template <typename T>
glm::dvec3 way_to(const typename Flat<T>::Cone& cone, Dice& dice) {
    const double length = cone.length, wide = std::fabs(double(cone.slope)) * length;
    const double at = dice.uniform(-0.25, 1.25) * length;
    const double reach = 1.5 * (double(cone.base_radius) + wide) * dice.uniform(0, 1);
    return in_double(cone.base) + at * in_double(cone.axis) + reach * dice.direction();
}

/// The height over the base, as a share of the length, at which an exact ray from this surface of
/// the cone meets it again at distance t > 0; negative where it does not.
struct Return {
    Quad t = -1;
    double height = -1;
};

template <typename T>
Return exact_return(const trace::Surface<T>& start, const Vec3<T>& dir,
                    const stress::WideFrustum<Quad>& cone) {
    const Wide3<Quad> along = in_quad(start.point) - cone.base;
    const Quad height = dot(along, cone.axis);
    const Wide3<Quad> outwards = unit(along - height * cone.axis);
    stress::WideRay<Quad> ray;
    ray.origin = cone.base + height * cone.axis + (cone.radius + cone.slope * height) * outwards;
    ray.dir = unit(in_quad(dir));
    stress::WideFrustum<Quad> endless = cone;  // where it would go on beyond its rims, too
    endless.base = cone.base - cone.length * cone.axis;
    endless.radius = cone.radius - cone.length * cone.slope;
    endless.length = 3 * cone.length;
    const Quad t = stress::hit_frustum(ray, endless, true);
    if (!(t > 0)) return {};
    const Quad share = (height + t * dot(ray.dir, cone.axis)) / cone.length;
    return {t, static_cast<double>(share)};
}

/// Outwards nothing must be hit; inwards the exact far side, where it lies clear of the rims.
template <typename T>
void leave_cone(const trace::SceneView<T>& view, const stress::WideFrustum<Quad>& exact,
                double shallowest, Dice& dice, RayFigures& figures) {
    const trace::Ray<T> eye = make_ray<T>(Vec3<T>(T(0)), way_to<T>(view.cones[0], dice));
    const trace::Hit<T> hit = trace::closest_hit(view, eye);
    if (hit.prim != view.frame.sphere_count) return;
    const trace::Surface<T> surface = trace::surface_at(view, eye, hit);
    const glm::dvec3 normal = glm::normalize(in_double(surface.normal));
    const bool outwards = dice.index(4) != 0;
    const double steepest = std::numbers::pi / 2;
    const double angle =
        outwards ? (dice.index(3) == 0 ? dice.uniform(0.1, steepest) : dice.log_uniform(1e-6, 0.1))
                 : -dice.log_uniform(shallowest, steepest);
    trace::Ray<T> ray = make_ray<T>(surface.point, at_angle(dice, normal, angle));
    ray.origin = trace::offset_origin(surface, ray.dir);
    ray.from = hit.prim;
    ray.chord = -surface.diameter * trace::dot3(surface.geometric, ray.dir);
    const trace::Hit<T> again = trace::closest_hit(view, ray);
    const bool found = again.prim == hit.prim;
    if (outwards) {
        ++figures.rays;
        figures.failures += found ? 1 : 0;
        return;
    }
    const Return far = exact_return(surface, ray.dir, exact);
    constexpr double clear = 1e-3;
    const bool returns = far.height > clear && far.height < 1 - clear;
    if (!returns && far.height > -clear && far.height < 1 + clear && far.t > 0) return;
    ++figures.rays;
    const double error = found && returns ? relative_error(double(again.t), far.t) : 0;
    figures.failures += found == returns && error <= 1e-2 ? 0 : 1;
    figures.max_error = std::max(figures.max_error, error);
}

}  // namespace

template <typename T>
RayFigures count_cone_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays) {
    const FlatScene<T> flat = flatten<T>(scene);
    const trace::SceneView<T> view = trace::view_of(flat);
    const stress::WideFrustum<Quad> exact = exact_frustum<T>(flat.cones[0]);
    return many_rays(rays, [&](Dice& dice, RayFigures& figures) {
        leave_cone(view, exact, shallowest, dice, figures);
    });
}

template <typename T>
RayFigures count_cone_failures(const Scene& scene, std::uint64_t rays) {
    const FlatScene<T> flat = flatten<T>(scene);
    const trace::SceneView<T> view = trace::view_of(flat);
    const stress::WideFrustum<Quad> cone = exact_frustum<T>(flat.cones[0]);
    return many_rays(rays, [&](Dice& dice, RayFigures& figures) {
        const trace::Ray<T> ray = make_ray<T>(Vec3<T>(T(0)), way_to<T>(flat.cones[0], dice));
        const trace::Hit<T> hit = trace::closest_hit(view, ray);
        const Quad exact =
            stress::hit_frustum<Quad>({in_quad(ray.origin), in_quad(ray.dir)}, cone, false);
        ++figures.rays;
        const bool found = hit.prim == flat.frame.sphere_count;
        if (found != (exact > 0)) {
            ++figures.failures;
        } else if (found) {
            figures.max_error = std::max(figures.max_error, relative_error(double(hit.t), exact));
        }
    });
}

template RayFigures count_cone_leaving_failures<float>(const Scene&, double, std::uint64_t);
template RayFigures count_cone_leaving_failures<double>(const Scene&, double, std::uint64_t);
template RayFigures count_cone_failures<float>(const Scene&, std::uint64_t);
template RayFigures count_cone_failures<double>(const Scene&, std::uint64_t);

}  // namespace rt
