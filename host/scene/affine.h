// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace rt {

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

/// Whether the linear part mirrors (negative determinant).
bool mirrors(const glm::dmat3& linear);

}  // namespace rt
