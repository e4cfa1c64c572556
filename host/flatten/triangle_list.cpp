// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/triangle_list.h"

#include <algorithm>

namespace rt {

TriangleList::TriangleList(const Scene& scene) : scene_(scene), starts_{scene.triangles.size()} {
    for (const Scene::Mesh& mesh : scene.meshes) {
        starts_.push_back(starts_.back() + mesh.faces.size());
    }
}

TriangleList::Place TriangleList::place(std::size_t index) const {
    if (index < scene_.triangles.size()) return {nullptr, index};
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), index);
    const auto mesh = static_cast<std::size_t>(after - starts_.begin()) - 1;
    return {&scene_.meshes[mesh], index - static_cast<std::size_t>(starts_[mesh])};
}

TriangleList::Corners TriangleList::corners(std::size_t index) const {
    const Place at = place(index);
    if (!at.mesh) return scene_.triangles[at.index].vertices;
    const Scene::Mesh::Face& face = at.mesh->faces[at.index];
    const auto& positions = at.mesh->positions;
    return {positions[face[0]], positions[face[1]], positions[face[2]]};
}

int TriangleList::material(std::size_t index) const {
    const Place at = place(index);
    if (!at.mesh) return scene_.triangles[at.index].material;
    const auto& materials = at.mesh->face_materials;
    return materials.size() == 1 ? materials[0] : materials[at.index];
}

bool TriangleList::is_smooth(std::size_t index) const {
    const Place at = place(index);
    if (!at.mesh) return scene_.triangles[at.index].normals.has_value();
    const auto& rows = at.mesh->face_normals;
    return !rows.empty() && rows[at.index][0] != Scene::Mesh::no_normal;
}

std::optional<TriangleList::Corners> TriangleList::normals(std::size_t index) const {
    if (!is_smooth(index)) return std::nullopt;
    const Place at = place(index);
    if (!at.mesh) return scene_.triangles[at.index].normals;
    const Scene::Mesh::Face& row = at.mesh->face_normals[at.index];
    const auto& normals = at.mesh->normals;
    return Corners{normals[row[0]], normals[row[1]], normals[row[2]]};
}

}  // namespace rt
