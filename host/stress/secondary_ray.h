// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>

#include "host/stress/ray_dice.h"
#include "host/trace/closest_hit.h"
#include "host/trace/hit_surface.h"

// Rays that leave a shape the eye sees, at random.
namespace rt {

template <typename T>
struct SecondaryRay {
    trace::Surface<T> start;
    trace::Ray<T> ray;
    bool outwards;  ///< to the side of the start's normal
};

/// Radians over the surface, negative inwards. Outwards two in three are below 0.1, down to 1e-6;
/// inwards they go down to `shallowest`.
inline double leaving_angle(Dice& dice, bool outwards, double shallowest) {
    constexpr double steepest = std::numbers::pi / 2;
    if (!outwards) return -dice.log_uniform(shallowest, steepest);
    return dice.index(3) == 0 ? dice.uniform(0.1, steepest) : dice.log_uniform(1e-6, 0.1);
}

/// The ray on from where a ray from the eye through the target hits primitive prim, three in four
/// outwards; nothing where it does not hit.
template <typename T>
std::optional<SecondaryRay<T>> leave_primitive(const trace::SceneView<T>& view,
                                               typename Flat<T>::Index prim,
                                               const glm::dvec3& target, double shallowest,
                                               Dice& dice) {
    const trace::Ray<T> eye = make_ray<T>(Vec3<T>(T(0)), target);
    const trace::Hit<T> hit = trace::closest_hit(view, eye);
    if (hit.prim != prim) return {};
    const trace::Surface<T> start = trace::surface_at(view, eye, hit);
    const glm::dvec3 normal = glm::normalize(in_double(start.normal));
    const bool outwards = dice.index(4) != 0;
    const double angle = leaving_angle(dice, outwards, shallowest);
    const Vec3<T> dir = rounded_unit<T>(at_angle(dice, normal, angle));
    const Vec3<T> origin = trace::offset_origin(start, dir);
    return SecondaryRay<T>{start, trace::leave_surface(start, origin, dir, prim), outwards};
}

}  // namespace rt
