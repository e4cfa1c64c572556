// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace rt {

/// The largest magnitude of a coordinate.
inline double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Normalizes v at any scale (no overflow or underflow); empty for a zero vector.
std::optional<glm::dvec3> unit_direction(glm::dvec3 v);

/// Whether the two points differ by rounding only: at most a few units in the last place of the
/// larger coordinate on every axis.
bool nearly_same_point(glm::dvec3 a, glm::dvec3 b);

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

/// p -> linear * p + translation.
struct Affine {
    glm::dmat3 linear{1};
    glm::dvec3 translation{0};

    bool operator==(const Affine&) const = default;
};

/// Scales, then rotates about x, y and z in this order (degrees, counterclockwise seen from the tip
/// of the axis), then translates.
Affine make_affine(glm::dvec3 scale, glm::dvec3 degrees, glm::dvec3 translation);

/// The matrix that transforms normals (inverse transpose, up to a positive factor); empty when
/// `linear` is singular up to rounding, whatever its scale.
std::optional<glm::dmat3> normal_matrix(const glm::dmat3& linear);

/// v turned about the unit vector `axis`, counterclockwise seen from its tip.
glm::dvec3 turned(glm::dvec3 v, glm::dvec3 axis, double degrees);

/// Whether the linear part mirrors (negative determinant).
bool mirrors(const glm::dmat3& linear);

/// On which side of the line from a to b the point c lies: 1 on its left, -1 on its right, 0 on
/// it. Exact for coordinates whose products neither overflow nor underflow (Shewchuk, Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
int orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c);

}  // namespace rt
