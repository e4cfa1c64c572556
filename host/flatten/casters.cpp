// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/casters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "host/scene/geometry.h"

namespace rt {

namespace {

/// Error of a distance to a plane through rounded points, relative to coordinates.
constexpr double rounding = 0x1p-48;
/// Relative to the scene: closer to a plane than this, a light, or a surface, is in doubt.
constexpr double near_light = 0x1p-8, near_surface = 0x1p-12;

struct Plane {
    glm::dvec3 point, normal;

    explicit Plane(const TriangleList::Corners& corners)
        : point(corners[0]), normal(unit_normal(corners)) {}

    double height(const glm::dvec3& p) const { return glm::dot(normal, p - point); }
    double doubt(const glm::dvec3& p) const { return rounding * (largest(p) + largest(point)); }
};

/// The range of heights over a plane of everything in the scene.
struct Heights {
    double lowest = 0, highest = 0;  ///< with heights within rounding error taken as 0
    double extent = 0;               ///< largest coordinate distance from the plane's point
    /// Least of a point on a sphere or cone from where a shadow ray's first step may be downwards.
    double nearest_round = std::numeric_limits<double>::infinity();

    /// Returns how far off the plane it all is.
    double add(const Plane& plane, const glm::dvec3& center, double reach) {
        const double height = plane.height(center);
        const double doubt = plane.doubt(center) + rounding * reach;
        if (height - reach < -doubt) lowest = std::min(lowest, height - reach);
        if (height + reach > doubt) highest = std::max(highest, height + reach);
        extent = std::max(extent, largest(center - plane.point) + reach);
        return std::fabs(height) - reach;
    }
};

/// Half the extent of a disc about `axis` (unit), seen along the plane's normal.
double disc_reach(const Plane& plane, const glm::dvec3& axis, double radius) {
    const double cosine = glm::dot(plane.normal, axis);
    return radius * std::sqrt(std::max(0.0, 1 - cosine * cosine) + rounding);
}

Heights heights_over(const Plane& plane, const Scene& scene, const TriangleList& triangles,
                     std::span<const glm::dvec3> eyes, const glm::dvec3& light) {
    Heights heights;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const glm::dvec3& corner : triangles.corners(i)) heights.add(plane, corner, 0);
    }
    for (const auto& sphere : scene.spheres) {
        heights.add(plane, sphere.center, sphere.radius);
        // The least sine of the light's elevation, from a point of the sphere near the plane.
        const double sine =
            0.9 * plane.height(light) / (glm::length(light - sphere.center) + sphere.radius);
        const double below = sphere.radius * std::sqrt(std::max(0.0, 1 - sine * sine));
        heights.nearest_round =
            std::min(heights.nearest_round, std::fabs(plane.height(sphere.center)) - below);
    }
    for (const auto& cone : scene.cones) {
        const glm::dvec3 axis = glm::normalize(cone.apex - cone.base);
        heights.nearest_round =
            std::min({heights.nearest_round,
                      heights.add(plane, cone.base, disc_reach(plane, axis, cone.base_radius)),
                      heights.add(plane, cone.apex, disc_reach(plane, axis, cone.apex_radius))});
    }
    for (const glm::dvec3& eye : eyes) heights.add(plane, eye, 0);
    heights.add(plane, light, 0);
    return heights;
}

/// Whether a shadow ray that starts on the other triangle, where that meets the plane, may begin
/// beyond the plane: start points are offset along the surface normal, to the light's side.
bool steps_through(const Plane& plane, const TriangleList::Corners& other, const glm::dvec3& light,
                   double extent) {
    double nearest = extent, farthest = 0;
    for (const glm::dvec3& corner : other) {
        const double height = std::fabs(plane.height(corner));
        nearest = std::min(nearest, height);
        farthest = std::max(farthest, height - plane.doubt(corner));
    }
    if (nearest > near_surface * extent || farthest <= 0) return false;
    const Plane surface(other);
    const double lit = (surface.height(light) < 0) == (plane.height(light) < 0) ? 1 : -1;
    return lit * glm::dot(plane.normal, surface.normal) < -near_surface;
}

bool casts(const Scene& scene, const TriangleList& triangles, std::span<const glm::dvec3> eyes,
           const glm::dvec3& light, std::size_t index) {
    const Plane plane(triangles.corners(index));
    const Heights heights = heights_over(plane, scene, triangles, eyes, light);
    if (heights.lowest < 0 && heights.highest > 0) return true;
    if (!(std::fabs(plane.height(light)) > near_light * heights.extent)) return true;
    if (!(heights.nearest_round > near_surface * heights.extent)) return true;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i == index) continue;
        if (steps_through(plane, triangles.corners(i), light, heights.extent)) return true;
    }
    return false;
}

}  // namespace

std::vector<std::size_t> shadow_casters(const Scene& scene, const TriangleList& triangles,
                                        std::span<const glm::dvec3> eyes, const glm::dvec3& light) {
    std::vector<std::size_t> casters;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (casts(scene, triangles, eyes, light, i)) casters.push_back(i);
    }
    return casters;
}

}  // namespace rt
