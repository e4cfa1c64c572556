// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/triangle_list.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace rt {

namespace {

/// a b - c d (Kahan).
double difference_of_products(double a, double b, double c, double d) {
    const double product = c * d;
    return std::fma(a, b, -product) + std::fma(-c, d, product);
}

}  // namespace

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

/// Rounding tilts the plane of a thin triangle by u over its sine; at the far end of a long one
/// that is more than its width.
glm::dvec3 unit_normal(const TriangleList::Corners& corners) {
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
    glm::dvec3 normal = glm::cross(a, b);
    if (glm::dot(normal, normal) < 0x1p-8 * glm::dot(a, a) * glm::dot(b, b)) {
        normal = {difference_of_products(a.y, b.z, b.y, a.z),
                  difference_of_products(a.z, b.x, b.z, a.x),
                  difference_of_products(a.x, b.y, b.x, a.y)};
    }
    return glm::normalize(normal);
}

}  // namespace rt
