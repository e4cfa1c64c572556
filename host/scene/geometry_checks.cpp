// SPDX-License-Identifier: Apache-2.0
#include "host/scene/geometry_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace rt {
namespace {

constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

double largest(glm::dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Scales every axis by its own power of two, exactly, so that its largest coordinate lies in
/// 0.5..1 (or is 0). Collinearity is unchanged.
std::array<glm::dvec3, 3> scaled_per_axis(std::array<glm::dvec3, 3> corners) {
    for (int axis = 0; axis < 3; ++axis) {
        double size = 0;
        for (const glm::dvec3& corner : corners) size = std::max(size, std::abs(corner[axis]));
        int exponent = 0;
        std::frexp(size, &exponent);
        for (glm::dvec3& corner : corners) corner[axis] = std::ldexp(corner[axis], -exponent);
    }
    return corners;
}

/// Whether one component of the normal exceeds any rounding error: true for most triangles, and far
/// cheaper than scaling them. Scaling is by at most twice the coordinates, so it stays above the
/// largest error that zero_area allows (8 roundings).
bool clearly_has_area(const std::array<glm::dvec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 size = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    const glm::dvec3 normal = glm::abs(glm::cross(b - a, c - a));
    constexpr double slack = 64 * rounding;
    return normal.x > slack * (size.y * size.z) || normal.y > slack * (size.z * size.x) ||
           normal.z > slack * (size.x * size.y);
}

}  // namespace

std::optional<glm::dvec3> unit_direction(glm::dvec3 v) {
    const double size = largest(v);
    if (size == 0) return std::nullopt;
    const glm::dvec3 scaled(v.x / size, v.y / size, v.z / size);
    return scaled / glm::length(scaled);
}

bool nearly_same_point(glm::dvec3 a, glm::dvec3 b) {
    for (int axis = 0; axis < 3; ++axis) {
        const double size = std::max(std::abs(a[axis]), std::abs(b[axis]));
        if (std::abs(a[axis] - b[axis]) > rounding * size) return false;
    }
    return true;
}

bool nearly_parallel(glm::dvec3 a, glm::dvec3 b) {
    constexpr double smallest_sine = 1e-9;
    return largest(glm::cross(a, b)) < smallest_sine;
}

/// Each component of the edges carries one rounding error (the coordinates are at most 1 after
/// scaling), so the cross product counts as zero below the resulting error bound.
bool zero_area(const std::array<glm::dvec3, 3>& corners) {
    if (clearly_has_area(corners)) return false;
    const auto [a, b, c] = scaled_per_axis(corners);
    const glm::dvec3 e = b - a, f = c - a;
    const glm::dvec3 normal = glm::cross(e, f);
    const auto vanishes = [&](int x, int y, int z) {
        const double error =
            rounding * (std::abs(e[y]) + std::abs(f[y]) + std::abs(e[z]) + std::abs(f[z]));
        return std::abs(normal[x]) <= error;
    };
    return vanishes(0, 1, 2) && vanishes(1, 2, 0) && vanishes(2, 0, 1);
}

std::optional<AxesMistake> find_axes_mistake(glm::dvec3 from, glm::dvec3 at, glm::dvec3 up) {
    if (nearly_same_point(from, at)) {
        return AxesMistake{false, "from and at are the same point; move one of them"};
    }
    const auto view = unit_direction(at - from);
    const auto up_direction = unit_direction(up);
    if (!up_direction) {
        return AxesMistake{true, "up is zero; write the direction that points up in the picture"};
    }
    if (nearly_parallel(*view, *up_direction)) {
        return AxesMistake{true, "up is parallel to the view direction; choose another direction"};
    }
    return std::nullopt;
}

}  // namespace rt
