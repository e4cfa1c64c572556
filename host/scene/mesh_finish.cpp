// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh_finish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/parallel.h"
#include "host/scene/geometry_checks.h"
#include "host/scene/scene_limits.h"

namespace rt {
namespace {

using Face = Scene::Mesh::Face;

bool is_within(const glm::dvec3& p) {
    const auto good = [](double x) { return std::abs(x) <= max_scene_number; };
    return good(p.x) && good(p.y) && good(p.z);
}

/// Transforms the positions and returns whether those of all faces are in range.
bool move_positions(Scene::Mesh& mesh, const Affine& transform) {
    for (glm::dvec3& p : mesh.positions) p = transform.linear * p + transform.translation;
    if (std::ranges::all_of(mesh.positions, is_within)) return true;
    for (const Face& face : mesh.faces) {
        for (const std::uint32_t i : face) {
            if (!is_within(mesh.positions[i])) return false;
        }
    }
    for (glm::dvec3& p : mesh.positions) {
        if (!is_within(p)) p = glm::dvec3(0);
    }
    return true;
}

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

/// Indices of the triangles without area, ascending: nearly always none. Runs in parallel.
std::vector<std::size_t> find_zero_areas(const Scene::Mesh& mesh) {
    constexpr std::size_t grain = 1 << 15;
    std::vector<std::vector<std::size_t>> found((mesh.faces.size() + grain - 1) / grain);
    for_each_run(mesh.faces.size(), grain, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) {
                         const auto [a, b, c] = mesh.faces[i];
                         const auto& p = mesh.positions;
                         if (zero_area({p[a], p[b], p[c]})) found[first / grain].push_back(i);
                     }
                 });
    std::vector<std::size_t> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Removes the items at these ascending indices.
template <typename Item>
void take_out(std::vector<Item>& items, const std::vector<std::size_t>& places) {
    std::size_t kept = 0, next = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (next < places.size() && places[next] == i) {
            ++next;
        } else {
            items[kept++] = items[i];
        }
    }
    items.resize(kept);
}

/// Removes the triangles without area and returns their number.
std::size_t drop_zero_areas(Scene::Mesh& mesh) {
    const std::vector<std::size_t> places = find_zero_areas(mesh);
    if (places.empty()) return 0;
    const bool many_materials = mesh.face_materials.size() == mesh.faces.size();
    if (many_materials && places.size() < mesh.faces.size()) take_out(mesh.face_materials, places);
    if (!mesh.face_normals.empty()) take_out(mesh.face_normals, places);
    take_out(mesh.faces, places);
    return places.size();
}

void turn_round(std::vector<Face>& faces) {
    for (Face& face : faces) std::swap(face[1], face[2]);
}

}  // namespace

MeshLosses finish_mesh(Scene::Mesh& mesh, const Affine& transform) {
    MeshLosses losses;
    if (transform != Affine{}) losses.too_far = !move_positions(mesh, transform);
    const auto matrix = normal_matrix(transform.linear);
    const bool any_zero = turn_normals(mesh.normals, matrix.value_or(glm::dmat3(1)));
    losses.zero_areas = drop_zero_areas(mesh);
    constexpr std::uint32_t none = Scene::Mesh::no_normal;
    for (Face& normals : mesh.face_normals) {
        if (!any_zero || !has_zero_normal(mesh, normals)) continue;
        normals = {none, none, none};
        ++losses.flat_faces;
    }
    if (mirrors(transform.linear)) {
        turn_round(mesh.faces);
        turn_round(mesh.face_normals);
    }
    return losses;
}

}  // namespace rt
