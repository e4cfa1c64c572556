// SPDX-License-Identifier: Apache-2.0
#include "host/scene/affine.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "host/scene/geometry_checks.h"

namespace rt {
namespace {

/// The columns of the inverse transpose times the determinant.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

double determinant(const glm::dmat3& m) { return glm::dot(m[0], glm::cross(m[1], m[2])); }

double largest(const glm::dmat3& m) {
    double size = 0;
    for (int i = 0; i < 9; ++i) size = std::max(size, std::abs(m[i / 3][i % 3]));
    return size;
}

/// Normalizes the columns; empty if one is zero.
std::optional<glm::dmat3> unit_columns(const glm::dmat3& m) {
    glm::dmat3 result(0);
    for (int i = 0; i < 3; ++i) {
        const auto unit = unit_direction(m[i]);
        if (!unit) return std::nullopt;
        result[i] = *unit;
    }
    return result;
}

/// Scales rows and columns to about unit length, so that the determinant depends only on angles.
std::optional<glm::dmat3> without_scales(const glm::dmat3& m) {
    const auto columns = unit_columns(m);
    return columns ? unit_columns(glm::transpose(*columns)) : std::nullopt;
}

/// Sine and cosine, exact for whole quarter turns.
void sine_cosine(double degrees, double& sine, double& cosine) {
    const double turn = std::fmod(degrees, 360.0);
    const double quarters = std::nearbyint(turn / 90.0);
    const double angle = (turn - 90.0 * quarters) * (std::numbers::pi / 180.0);
    const double s = std::sin(angle), c = std::cos(angle);
    const double sines[] = {s, c, -s, -c}, cosines[] = {c, -s, -c, s};
    const int which = static_cast<int>(quarters) & 3;
    sine = sines[which];
    cosine = cosines[which];
}

/// The rotation that turns `from` toward `to` (axis numbers).
glm::dmat3 rotation(double degrees, int from, int to) {
    double sine = 0, cosine = 1;
    sine_cosine(degrees, sine, cosine);
    glm::dmat3 m(1);
    m[from][from] = m[to][to] = cosine;
    m[from][to] = sine;
    m[to][from] = -sine;
    return m;
}

}  // namespace

Affine make_affine(glm::dvec3 scale, glm::dvec3 degrees, glm::dvec3 translation) {
    const glm::dmat3 turn =
        rotation(degrees.z, 0, 1) * rotation(degrees.y, 2, 0) * rotation(degrees.x, 1, 2);
    return {{turn[0] * scale.x, turn[1] * scale.y, turn[2] * scale.z}, translation};
}

std::optional<glm::dmat3> normal_matrix(const glm::dmat3& linear) {
    constexpr double smallest = 1e-12;
    const auto bare = without_scales(linear);
    if (!bare || !(std::abs(determinant(*bare)) > smallest)) return std::nullopt;
    const double size = largest(linear);
    glm::dmat3 scaled = linear;
    for (int i = 0; i < 9; ++i) scaled[i / 3][i % 3] /= size;
    glm::dmat3 result = cofactors(scaled);
    if (mirrors(linear)) result *= -1.0;
    return result;
}

bool mirrors(const glm::dmat3& linear) {
    const auto bare = without_scales(linear);
    return bare && determinant(*bare) < 0;
}

}  // namespace rt
