// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"

namespace rt {
namespace {

using Face = Scene::Mesh::Face;

constexpr Face flat_face = {Scene::Mesh::no_normal, Scene::Mesh::no_normal, Scene::Mesh::no_normal};

/// Appends the triangle of three of a face's corners.
void append_triangle(const Face& which, std::span<const std::uint32_t> corners,
                     std::span<const std::uint32_t> normals, std::vector<Face>& faces,
                     std::vector<Face>* face_normals) {
    const auto [a, b, c] = which;
    faces.push_back({corners[a], corners[b], corners[c]});
    if (!face_normals) return;
    face_normals->push_back(normals.empty() ? flat_face : Face{normals[a], normals[b], normals[c]});
}

constexpr std::size_t grain = 1 << 15;  // faces that a thread takes at a time

/// Transforms the normals to unit length and returns whether any is zero, which stays zero.
bool turn_normals(std::vector<glm::dvec3>& normals, const glm::dmat3& matrix) {
    bool any_zero = false;
    for (glm::dvec3& normal : normals) {
        auto unit = unit_direction(normal);
        if (unit) unit = unit_direction(matrix * *unit);
        if (!unit) any_zero = true;
        normal = unit.value_or(glm::dvec3(0));
    }
    return any_zero;
}

bool has_zero_normal(const Scene::Mesh& mesh, const Face& normals) {
    return std::ranges::any_of(normals, [&](std::uint32_t i) {
        return i != Scene::Mesh::no_normal && mesh.normals[i] == glm::dvec3(0);
    });
}

/// Removes the items whose mark is set.
template <typename Item>
void take_out(std::vector<Item>& items, const std::vector<char>& marks) {
    std::size_t i = 0;
    std::erase_if(items, [&](const Item&) { return marks[i++] != 0; });
}

/// Removes the triangles without area, found in parallel, and returns their number.
std::size_t drop_zero_areas(Scene::Mesh& mesh) {
    std::vector<char> marks(mesh.faces.size());
    for_each_run(marks.size(), grain, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto [a, b, c] = mesh.faces[i];
            const auto& p = mesh.positions;
            marks[i] = zero_area({p[a], p[b], p[c]}) ? 1 : 0;
        }
    });
    const auto count = static_cast<std::size_t>(std::ranges::count(marks, 1));
    if (count == 0) return 0;
    const bool many_materials = mesh.face_materials.size() == mesh.faces.size();
    if (many_materials && count < mesh.faces.size()) take_out(mesh.face_materials, marks);
    if (!mesh.face_normals.empty()) take_out(mesh.face_normals, marks);
    take_out(mesh.faces, marks);
    return count;
}

void turn_round(std::vector<Face>& faces) {
    for (Face& face : faces) std::swap(face[1], face[2]);
}

/// Calls work(value, position) for the corners of all faces, in parallel. Each run of faces has its
/// own value, initially `start`; returns these values.
template <typename Value, typename Work>
std::vector<Value> over_corners(const Scene::Mesh& mesh, const Value& start, Work work) {
    std::vector<Value> values((mesh.faces.size() + grain - 1) / grain, start);
    for_each_run(mesh.faces.size(), grain, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     Value value = start;
                     for (std::size_t f = first; f < last; ++f) {
                         for (const std::uint32_t i : mesh.faces[f]) work(value, mesh.positions[i]);
                     }
                     values[first / grain] = value;
                 });
    return values;
}

}  // namespace

bool parts_well(const std::array<glm::dvec3, 4>& quad) {
    const glm::dvec3 diagonal = quad[2] - quad[0];
    const glm::dvec3 one = glm::cross(quad[1] - quad[0], diagonal);
    const glm::dvec3 other = glm::cross(diagonal, quad[3] - quad[0]);
    return glm::dot(one, other) > 0.5 * glm::length(one) * glm::length(other);
}

const PolygonBlemish* append_face(std::span<const std::uint32_t> corners,
                                  std::span<const std::uint32_t> normals,
                                  const std::vector<glm::dvec3>& positions, std::size_t file_bytes,
                                  std::vector<Face>& faces, std::vector<Face>* face_normals) {
    const auto& p = positions;
    const auto& c = corners;
    const bool is_quad = c.size() == 4 && parts_well({p[c[0]], p[c[1]], p[c[2]], p[c[3]]});
    if (c.size() == 3 || is_quad) {
        append_triangle({0, 1, 2}, corners, normals, faces, face_normals);
        if (is_quad) append_triangle({0, 2, 3}, corners, normals, faces, face_normals);
        return nullptr;
    }
    std::vector<glm::dvec3> outline;
    for (const std::uint32_t corner : corners) outline.push_back(positions[corner]);
    std::vector<Face> parts;
    const PolygonBlemish* const blemish = split_polygon(outline, file_bytes, parts);
    for (const Face& which : parts) append_triangle(which, corners, normals, faces, face_normals);
    return blemish;
}

void finish_mesh(Scene::Mesh& mesh, const Affine& transform, const std::string& path,
                 std::vector<std::string>& notes) {
    if (transform != Affine{}) {
        for (glm::dvec3& p : mesh.positions) p = transform.linear * p + transform.translation;
        if (!std::ranges::all_of(mesh.positions, is_within)) {
            throw Error(ExitCode::input, path +
                                             ": a vertex exceeds 1e30 after the transform; "
                                             "make the transform smaller");
        }
    }
    const auto matrix = normal_matrix(transform.linear);
    const bool any_zero = turn_normals(mesh.normals, matrix.value_or(glm::dmat3(1)));
    const std::size_t zero_areas = drop_zero_areas(mesh);
    if (mesh.faces.empty()) {
        throw Error(ExitCode::input, path +
                                         ": no face has any area, so there is nothing to draw; "
                                         "use a model with faces");
    }
    if (zero_areas > 0) {
        notes.push_back(
            fmt::format("{}: ignored {}", path, counted(zero_areas, "zero-area triangle")));
    }
    std::size_t flat_faces = 0;
    for (Face& normals : mesh.face_normals) {
        if (!any_zero || !has_zero_normal(mesh, normals)) continue;
        normals = flat_face;
        ++flat_faces;
    }
    if (flat_faces > 0) {
        notes.push_back(fmt::format("{}: {} flat, as a vertex normal has length 0", path,
                                    counted(flat_faces, "face is", "faces are")));
    }
    if (mirrors(transform.linear)) {
        turn_round(mesh.faces);
        turn_round(mesh.face_normals);
    }
}

Box bounding_box(const Scene::Mesh& mesh) {
    Box all;
    const auto boxes = over_corners(mesh, all, [](Box& box, const glm::dvec3& p) {
        box = {glm::min(box.low, p), glm::max(box.high, p)};
    });
    for (const Box& box : boxes) all = {glm::min(all.low, box.low), glm::max(all.high, box.high)};
    return all;
}

BoundingSphere bounding_sphere(const Scene::Mesh& mesh) {
    const Box box = bounding_box(mesh);
    BoundingSphere sphere{0.5 * box.low + 0.5 * box.high, 0};
    const auto radii = over_corners(mesh, 0.0, [&](double& radius, const glm::dvec3& p) {
        radius = std::max(radius, glm::length(p - sphere.center));
    });
    sphere.radius = std::ranges::max(radii);
    return sphere;
}

}  // namespace rt
