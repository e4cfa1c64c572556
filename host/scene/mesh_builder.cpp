// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh_builder.h"

#include <algorithm>
#include <utility>

#include "host/scene/polygon.h"

namespace rt {
namespace {

using Face = Scene::Mesh::Face;

constexpr Face flat_face = {Scene::Mesh::no_normal, Scene::Mesh::no_normal, Scene::Mesh::no_normal};

Face pick(std::span<const std::uint32_t> items, const Face& which) {
    return {items[which[0]], items[which[1]], items[which[2]]};
}

}  // namespace

void MeshBuilder::add_triangle(const Face& face, const Face* normals) {
    if (normals && mesh.face_normals.empty()) {
        mesh.face_normals.reserve(mesh.faces.capacity());
        mesh.face_normals.assign(mesh.faces.size(), flat_face);
    }
    mesh.faces.push_back(face);
    if (normals) {
        mesh.face_normals.push_back(*normals);
    } else if (!mesh.face_normals.empty()) {
        mesh.face_normals.push_back(flat_face);
    }
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners,
                           std::span<const std::uint32_t> normals) {
    const auto add = [&](const Face& which) {
        const Face face = pick(corners, which);
        if (normals.empty()) return add_triangle(face, nullptr);
        const Face face_normals = pick(normals, which);
        add_triangle(face, &face_normals);
    };
    if (corners.size() == 3) return add({0, 1, 2});
    outline_.clear();
    for (const std::uint32_t corner : corners) outline_.push_back(mesh.positions[corner]);
    for (const Face& which : triangulate(outline_)) add(which);
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
