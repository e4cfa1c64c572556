// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

namespace rt {

/// Normalizes v at any scale (no overflow or underflow); empty for a zero vector.
std::optional<glm::dvec3> unit_direction(glm::dvec3 v);

/// Whether the two points differ by rounding only: at most a few units in the last place of the
/// larger coordinate on every axis.
bool nearly_same_point(glm::dvec3 a, glm::dvec3 b);

/// Whether two unit vectors are parallel: the sine of their angle is below 1e-9.
bool nearly_parallel(glm::dvec3 a, glm::dvec3 b);

/// Whether the corners are collinear (or coincide), up to a few units in the last place of their
/// coordinates.
bool zero_area(const std::array<glm::dvec3, 3>& corners);

inline constexpr const char* same_cone_ends = "apex is the same point as base; move one of them";
inline constexpr const char* zero_cone_radii = "both radii are 0; make one of them larger";

/// Why from, at and up are no valid camera.
struct AxesMistake {
    bool is_up = false;  ///< up is to blame, not from and at
    const char* message = "";
};

std::optional<AxesMistake> find_axes_mistake(glm::dvec3 from, glm::dvec3 at, glm::dvec3 up);

}  // namespace rt
