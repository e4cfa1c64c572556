// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh_finish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/scene/geometry_checks.h"
#include "host/scene/scene_limits.h"

namespace rt {
namespace {

using Face = Scene::Mesh::Face;

bool is_within(const glm::dvec3& p) {
    const auto good = [](double x) { return std::abs(x) <= max_scene_number; };
    return good(p.x) && good(p.y) && good(p.z);
}

/// Whether all positions are in range.
bool move_positions(std::vector<glm::dvec3>& positions, const Affine& transform) {
    for (glm::dvec3& p : positions) p = transform.linear * p + transform.translation;
    return std::all_of(positions.begin(), positions.end(), is_within);
}

/// Zero normals stay zero; their number.
std::size_t turn_normals(std::vector<glm::dvec3>& normals, const glm::dmat3& matrix) {
    std::size_t zeros = 0;
    for (glm::dvec3& normal : normals) {
        auto unit = unit_direction(normal);
        if (unit) unit = unit_direction(matrix * *unit);
        if (!unit) ++zeros;
        normal = unit.value_or(glm::dvec3(0));
    }
    return zeros;
}

bool has_zero_normal(const Scene::Mesh& mesh, const Face& normals) {
    return std::ranges::any_of(normals, [&](std::uint32_t i) {
        return i != Scene::Mesh::no_normal && mesh.normals[i] == glm::dvec3(0);
    });
}

/// How many triangles without area were taken out.
std::size_t drop_zero_areas(Scene::Mesh& mesh) {
    const bool many_materials = mesh.face_materials.size() == mesh.faces.size();
    const bool smooth = !mesh.face_normals.empty();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        const auto [a, b, c] = mesh.faces[i];
        if (zero_area({mesh.positions[a], mesh.positions[b], mesh.positions[c]})) continue;
        mesh.faces[kept] = mesh.faces[i];
        if (smooth) mesh.face_normals[kept] = mesh.face_normals[i];
        if (many_materials) mesh.face_materials[kept] = mesh.face_materials[i];
        ++kept;
    }
    const std::size_t dropped = mesh.faces.size() - kept;
    mesh.faces.resize(kept);
    if (smooth) mesh.face_normals.resize(kept);
    if (many_materials && kept > 0) mesh.face_materials.resize(kept);
    return dropped;
}

void turn_round(std::vector<Face>& faces) {
    for (Face& face : faces) std::swap(face[1], face[2]);
}

}  // namespace

MeshLosses finish_mesh(Scene::Mesh& mesh, const Affine& transform) {
    MeshLosses losses;
    if (transform != Affine{}) losses.too_far = !move_positions(mesh.positions, transform);
    const auto matrix = normal_matrix(transform.linear);
    losses.zero_normals = turn_normals(mesh.normals, matrix.value_or(glm::dmat3(1)));
    losses.zero_areas = drop_zero_areas(mesh);
    if (losses.zero_normals > 0) {
        constexpr std::uint32_t none = Scene::Mesh::no_normal;
        for (Face& normals : mesh.face_normals) {
            if (has_zero_normal(mesh, normals)) normals = {none, none, none};
        }
    }
    if (mirrors(transform.linear)) {
        turn_round(mesh.faces);
        turn_round(mesh.face_normals);
    }
    return losses;
}

}  // namespace rt
