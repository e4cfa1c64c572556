// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "host/flatten/flat_scene.h"
#include "host/stress/ray_dice.h"
#include "host/stress/ray_trials.h"
#include "host/stress/secondary_ray.h"
#include "host/stress/wide_shapes.h"
#include "host/trace/closest_hit.h"

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

/// Distance at which an exact ray from this surface of the cone meets it again, negative where it
/// does not; nothing where that is within a thousandth of the length of a rim.
template <typename T>
std::optional<Quad> exact_return(const trace::Surface<T>& start, const Vec3<T>& dir,
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
    const auto share = static_cast<double>((height + t * dot(ray.dir, cone.axis)) / cone.length);
    constexpr double clear = 1e-3;
    if (!(t > 0) || share <= -clear || share >= 1 + clear) return Quad(-1);
    if (share <= clear || share >= 1 - clear) return {};
    return t;
}

/// Outwards nothing must be hit; inwards the exact far side, where it lies clear of the rims.
template <typename T>
void leave_cone(const trace::SceneView<T>& view, const stress::WideFrustum<Quad>& cone,
                double shallowest, Dice& dice, RayFigures& figures) {
    const auto prim = view.frame.sphere_count;
    const glm::dvec3 target = way_to<T>(view.cones[0], dice);
    const auto leaving = leave_primitive<T>(view, prim, target, shallowest, dice);
    if (!leaving) return;
    const std::optional<Quad> exact =
        leaving->outwards ? Quad(-1) : exact_return(leaving->start, leaving->ray.dir, cone);
    if (!exact) return;
    const trace::Hit<T> hit = trace::closest_hit(view, leaving->ray);
    note_hit(figures, hit.prim == prim, double(hit.t), *exact, 1e-2);
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
        note_hit(figures, hit.prim == flat.frame.sphere_count, double(hit.t), exact);
    });
}

template RayFigures count_cone_leaving_failures<float>(const Scene&, double, std::uint64_t);
template RayFigures count_cone_leaving_failures<double>(const Scene&, double, std::uint64_t);
template RayFigures count_cone_failures<float>(const Scene&, std::uint64_t);
template RayFigures count_cone_failures<double>(const Scene&, std::uint64_t);

}  // namespace rt
