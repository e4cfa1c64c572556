// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "host/flatten/flat_scene.h"
#include "host/stress/ray_dice.h"
#include "host/stress/ray_trials.h"
#include "host/stress/secondary_ray.h"
#include "host/stress/wide_shapes.h"

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

/// A random direction past the cone: to a point within 1.5 times its extent.
template <typename T>
glm::dvec3 way_to(const typename Flat<T>::Cone& cone, Dice& dice) {
    const double length = cone.length, wide = std::fabs(double(cone.slope)) * length;
    const double at = dice.uniform(-0.25, 1.25) * length;
    const double reach = 1.5 * (double(cone.base_radius) + wide) * dice.uniform(0, 1);
    return in_double(cone.base) + at * in_double(cone.axis) + reach * dice.direction();
}

/// Distance at which an exact ray from this point of the cone hits it again, negative if it does
/// not; empty if that is within a thousandth of the length of a rim.
template <typename T>
std::optional<Quad> exact_return(const typename Flat<T>::Packed3& start,
                                 const typename Flat<T>::Packed3& dir,
                                 const stress::WideFrustum<Quad>& cone) {
    const Wide3<Quad> along = in_quad(start) - cone.base;
    const Quad height = dot(along, cone.axis);
    const Wide3<Quad> outwards = unit(along - height * cone.axis);
    stress::WideRay<Quad> ray;
    ray.origin = cone.base + height * cone.axis + (cone.radius + cone.slope * height) * outwards;
    ray.dir = unit(in_quad(dir));
    stress::WideFrustum<Quad> endless = cone;  // extended beyond both rims
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

}  // namespace

/// Outwards, nothing must be hit; inwards, the exact far side if it is clear of the rims.
template <typename T>
RayFigures count_cone_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                       const RayCaster& caster) {
    const FlatScene<T> flat = flatten<T>(scene);
    const stress::WideFrustum<Quad> cone = exact_frustum<T>(flat.cones[0]);
    const auto prim = flat.params.sphere_count;
    const auto make = [&](Dice& dice) {
        return ray_query<T>(glm::dvec3(0), way_to<T>(flat.cones[0], dice));
    };
    const auto go_on = [=](Dice& dice, auto& query, const auto& answer) {
        leave_primitive<T>(dice, query, answer, prim, shallowest);
    };
    return many_rays<T>(
        caster.tracer(flat), rays, make, go_on,
        [&](const auto& query, const auto& answer, RayFigures& figures) {
            if (!has_left<T>(query)) return;
            const std::optional<Quad> exact = is_outwards<T>(query, answer)
                                                  ? Quad(-1)
                                                  : exact_return<T>(answer.point, query.next, cone);
            if (!exact) return;
            note_hit(figures, answer.next_prim == prim, double(answer.next_t), *exact, 1e-2);
        });
}

template <typename T>
RayFigures count_cone_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster) {
    const FlatScene<T> flat = flatten<T>(scene);
    const stress::WideFrustum<Quad> cone = exact_frustum<T>(flat.cones[0]);
    const auto make = [&](Dice& dice) {
        return ray_query<T>(glm::dvec3(0), way_to<T>(flat.cones[0], dice));
    };
    return many_rays<T>(
        caster.tracer(flat), rays, make, nullptr,
        [&](const auto& query, const auto& answer, RayFigures& figures) {
            const Quad exact =
                stress::hit_frustum<Quad>({in_quad(query.origin), in_quad(query.dir)}, cone, false);
            note_hit(figures, answer.prim == flat.params.sphere_count, double(answer.t), exact);
        });
}

template RayFigures count_cone_leaving_failures<float>(const Scene&, double, std::uint64_t,
                                                       const RayCaster&);
template RayFigures count_cone_leaving_failures<double>(const Scene&, double, std::uint64_t,
                                                        const RayCaster&);
template RayFigures count_cone_failures<float>(const Scene&, std::uint64_t, const RayCaster&);
template RayFigures count_cone_failures<double>(const Scene&, std::uint64_t, const RayCaster&);

}  // namespace rt
