// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh_builder.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace rt {
namespace {

using Face = Scene::Mesh::Face;

constexpr Face flat_face = {Scene::Mesh::no_normal, Scene::Mesh::no_normal, Scene::Mesh::no_normal};

Face pick(std::span<const std::uint32_t> items, const Face& which) {
    return {items[which[0]], items[which[1]], items[which[2]]};
}

}  // namespace

bool parts_well(const std::array<glm::dvec3, 4>& quad) {
    const glm::dvec3 diagonal = quad[2] - quad[0];
    const glm::dvec3 one = glm::cross(quad[1] - quad[0], diagonal);
    const glm::dvec3 other = glm::cross(diagonal, quad[3] - quad[0]);
    return glm::dot(one, other) > 0.5 * glm::length(one) * glm::length(other);
}

void append_face(const Face& face, const Face* normals, std::vector<Face>& faces,
                 std::vector<Face>& face_normals) {
    if (normals && face_normals.empty()) {
        face_normals.reserve(faces.capacity());
        face_normals.assign(faces.size(), flat_face);
    }
    faces.push_back(face);
    if (normals) {
        face_normals.push_back(*normals);
    } else if (!face_normals.empty()) {
        face_normals.push_back(flat_face);
    }
}

void MeshBuilder::add_triangles(std::span<const Face> faces, std::span<const Face> normals) {
    std::vector<Face>& all = mesh.face_normals;
    if (!normals.empty() && all.empty()) {
        all.reserve(mesh.faces.capacity());
        all.assign(mesh.faces.size(), flat_face);
    }
    mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
    all.insert(all.end(), normals.begin(), normals.end());
    if (!all.empty()) all.resize(mesh.faces.size(), flat_face);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners,
                           std::span<const std::uint32_t> normals) {
    const auto add = [&](const Face& which) {
        const Face face = pick(corners, which);
        if (normals.empty()) return append_face(face, nullptr, mesh.faces, mesh.face_normals);
        const Face face_normals = pick(normals, which);
        append_face(face, &face_normals, mesh.faces, mesh.face_normals);
    };
    if (corners.size() == 3) return add({0, 1, 2});
    outline_.clear();
    for (const std::uint32_t corner : corners) outline_.push_back(mesh.positions[corner]);
    const auto& o = outline_;
    if (o.size() == 4 && parts_well({o[0], o[1], o[2], o[3]})) {
        add({0, 1, 2});
        return add({0, 2, 3});
    }
    for (const Face& which : splitter_.split(outline_)) add(which);
}

void MeshBuilder::use_material(int material) {
    if (runs_.empty() || runs_.back().material != material) {
        runs_.push_back({mesh.faces.size(), material});
    }
}

Scene::Mesh MeshBuilder::take() {
    if (runs_.empty() || runs_[0].first_face > 0) runs_.insert(runs_.begin(), Run{0, -1});
    std::vector<int>& materials = mesh.face_materials;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        const std::size_t end = i + 1 < runs_.size() ? runs_[i + 1].first_face : mesh.faces.size();
        materials.resize(end, runs_[i].material);
    }
    const auto differs = [&](int material) { return material != materials[0]; };
    if (std::none_of(materials.begin(), materials.end(), differs)) {
        materials = {materials.empty() ? -1 : materials[0]};
    }
    return std::move(mesh);
}

}  // namespace rt
