// SPDX-License-Identifier: Apache-2.0
#include "host/scene/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "host/base/counted.h"
#include "host/scene/ear_clipper.h"
#include "host/scene/geometry_checks.h"

namespace rt {
namespace {

double largest_coordinate(glm::dvec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool on_one_line(std::span<const glm::dvec3> corners) {
    const glm::dvec3 start = corners[0];
    const glm::dvec3 end =
        *std::max_element(corners.begin(), corners.end(), [&](glm::dvec3 a, glm::dvec3 b) {
            return largest_coordinate(a - start) < largest_coordinate(b - start);
        });
    return std::all_of(corners.begin(), corners.end(), [&](glm::dvec3 corner) {
        return zero_area({start, end, corner});
    });
}

/// Newell's normal (Sutherland, Sproull and Schumacker 1974): its length is twice the area, at an
/// extent of 1.
glm::dvec3 normal_of(std::span<const glm::dvec3> corners) {
    double extent = 0;
    for (const glm::dvec3& corner : corners)
        extent = std::max(extent, largest_coordinate(corner - corners[0]));
    const auto scaled = [&](const glm::dvec3& corner) { return (corner - corners[0]) / extent; };
    glm::dvec3 normal{0};
    glm::dvec3 before = scaled(corners.back());
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 p = scaled(corner);
        normal += glm::cross(before, p);
        before = p;
    }
    return normal;
}

/// Projects the polygon along the axis nearest to its normal, counterclockwise. Coordinates are
/// only scaled by powers of two: nothing is rounded.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners, glm::dvec3 normal) {
    int axis = 0;
    if (std::abs(normal.y) > std::abs(normal[axis])) axis = 1;
    if (std::abs(normal.z) > std::abs(normal[axis])) axis = 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    double size = 0;
    for (const glm::dvec3& corner : corners) {
        size = std::max({size, std::abs(corner[u]), std::abs(corner[v])});
    }
    int exponent = 0;
    std::frexp(size, &exponent);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::dvec3& corner : corners) {
        flat.emplace_back(std::ldexp(corner[u], -exponent), std::ldexp(corner[v], -exponent));
    }
    return flat;
}

}  // namespace

PolygonFault triangulate(std::span<const glm::dvec3> corners, std::int64_t& work,
                         std::vector<std::array<std::uint32_t, 3>>& triangles) {
    triangles.clear();
    if (corners.size() == 3) {
        if (zero_area({corners[0], corners[1], corners[2]})) return PolygonFault::zero_area;
        triangles.push_back({0, 1, 2});
        return PolygonFault::none;
    }
    if (corners.size() < 3 || on_one_line(corners)) return PolygonFault::zero_area;
    const glm::dvec3 normal = normal_of(corners);
    if (largest_coordinate(normal) == 0) return PolygonFault::crosses_itself;
    const PolygonFault fault = EarClipper(flattened(corners, normal), work, triangles).run();
    std::erase_if(triangles, [&](const auto& triangle) {
        return zero_area({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]});
    });
    return fault;
}

const std::vector<std::array<std::uint32_t, 3>>& PolygonSplitter::split(
    std::span<const glm::dvec3> corners) {
    constexpr std::int64_t work_of_a_corner = 64;
    work_ = std::min(max_polygon_work,
                     std::max<std::int64_t>(work_, 0) +
                         work_of_a_corner * static_cast<std::int64_t>(corners.size()));
    const PolygonFault fault = triangulate(corners, work_, parts_);
    if (fault == PolygonFault::none) return parts_;
    parts_.clear();
    if (fault == PolygonFault::zero_area) {
        ++zero_areas_;
        return parts_;
    }
    ++fans_;
    for (std::uint32_t i = 2; i < corners.size(); ++i) parts_.push_back({0, i - 1, i});
    return parts_;
}

std::vector<std::string> PolygonSplitter::notes(const std::string& file_name) const {
    std::vector<std::string> notes;
    if (zero_areas_ > 0) {
        notes.push_back(
            fmt::format("{}: ignored {}", file_name, counted(zero_areas_, "zero-area polygon")));
    }
    if (fans_ > 0) {
        notes.push_back(fmt::format("{}: {} self-intersecting or too complex and may look wrong",
                                    file_name, counted(fans_, "polygon is", "polygons are")));
    }
    return notes;
}

}  // namespace rt
