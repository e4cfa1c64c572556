// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_polygon.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/scene/geometry_checks.h"

namespace rt {

bool NffPolygons::read(NffTokens& tokens, std::size_t offset, bool is_patch, NffFills& fills,
                       std::vector<Scene::Triangle>& triangles) {
    tokens.expect(is_patch ? "pp count, then count times x y z nx ny nz"
                           : "p count, then count times x y z");
    const auto count = read_count(tokens, is_patch ? 12 : 6);
    if (!count) return false;
    corners_.clear();
    normals_.clear();
    for (int i = 0; i < *count; ++i) {
        const auto corner = tokens.read_vec3("vertex");
        if (!corner) return false;
        corners_.push_back(*corner);
        if (is_patch && !read_normal(tokens)) return false;
    }
    const PolygonFault fault = triangulate(corners_, work_, faces_);
    note_fault(offset, fault);
    if (fault != PolygonFault::none) return true;
    for (const auto& [a, b, c] : faces_) {
        Scene::Triangle& triangle = triangles.emplace_back();
        triangle.vertices = {corners_[a], corners_[b], corners_[c]};
        if (is_patch) triangle.normals = {normals_[a], normals_[b], normals_[c]};
        triangle.material = fills.current();
    }
    return true;
}

/// Refuses, before allocating, a count of more vertices of at least `vertex_bytes` than the rest of
/// the file can hold.
std::optional<int> NffPolygons::read_count(NffTokens& tokens, std::size_t vertex_bytes) {
    const std::size_t offset = tokens.peek().offset;
    const auto count = tokens.read_integer("vertex count", 3, 1 << 30);
    if (!count) return std::nullopt;
    const std::size_t most = (tokens.bytes_left() + 1) / vertex_bytes;
    if (static_cast<std::size_t>(*count) <= most) return count;
    mistakes_.add(offset, fmt::format("vertex count is {}, and the rest of the file is too short "
                                      "for so many; write how many follow",
                                      *count));
    return std::nullopt;
}

bool NffPolygons::read_normal(NffTokens& tokens) {
    const std::size_t offset = tokens.peek().offset;
    const auto normal = tokens.read_vec3("normal");
    if (!normal) return false;
    const auto unit = unit_direction(*normal);
    if (!unit) mistakes_.add(offset, "a vertex normal is zero; give it a direction");
    normals_.push_back(unit.value_or(glm::dvec3(0, 0, 1)));
    return true;
}

void NffPolygons::note_fault(std::size_t offset, PolygonFault fault) {
    switch (fault) {
        case PolygonFault::none:
        case PolygonFault::zero_area:
            return;
        case PolygonFault::crosses_itself:
            return mistakes_.add(offset, "the polygon crosses itself; split it where it does");
        case PolygonFault::bent:
            return mistakes_.add(offset, "the polygon is not flat; split it into triangles");
        case PolygonFault::too_complex:
            throw Error(ExitCode::limit, mistakes_.place(offset) +
                                             ": the file's polygons are too complex; split "
                                             "those with thousands of vertices");
    }
}

}  // namespace rt
