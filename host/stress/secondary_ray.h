// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "host/stress/ray_dice.h"

// Random secondary rays from a shape that the eye sees.
namespace rt {

/// Radians above the surface, negative inwards. Outwards, two in three are below 0.1, down to 1e-6;
/// inwards, they go down to `shallowest`.
inline double leaving_angle(Dice& dice, bool outwards, double shallowest) {
    constexpr double steepest = std::numbers::pi / 2;
    if (!outwards) return -dice.log_uniform(shallowest, steepest);
    return dice.index(3) == 0 ? dice.uniform(0.1, steepest) : dice.log_uniform(1e-6, 0.1);
}

/// Continues an eye ray from its hit on primitive prim, three times in four outwards.
template <typename T>
void leave_primitive(Dice& dice, typename Flat<T>::RayQuery& query,
                     const typename Flat<T>::RayAnswer& answer, typename Flat<T>::Index prim,
                     double shallowest) {
    if (answer.prim != prim) return;
    const glm::dvec3 normal = glm::normalize(in_double(answer.normal));
    const double angle = leaving_angle(dice, dice.index(4) != 0, shallowest);
    query.next = rounded_unit<T>(at_angle(dice, normal, angle));
}

/// Whether the ray was continued, and whether to the normal's side.
template <typename T>
bool has_left(const typename Flat<T>::RayQuery& query) {
    return glm::length(in_double(query.next)) > 0;
}
template <typename T>
bool is_outwards(const typename Flat<T>::RayQuery& query,
                 const typename Flat<T>::RayAnswer& answer) {
    return glm::dot(in_double(query.next), in_double(answer.normal)) > 0;
}

}  // namespace rt
