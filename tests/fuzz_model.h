// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets expect of what they read.
#pragma once

#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "host/base/error.h"
#include "host/flatten/flat_scene.h"
#include "host/render/threads_renderer.h"
#include "host/scene/mesh.h"
#include "host/scene/model.h"
#include "tests/whole_film.h"

namespace rt::fuzz {

/// Traps on a bug in the reader, as opposed to an error in the text.
inline void require(bool condition) {
    if (!condition) __builtin_trap();
}

inline bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline void check_scene(const Scene& scene) {
    const int materials = static_cast<int>(scene.materials.size());
    const auto known = [&](int material) { return material >= 0 && material < materials; };
    for (const Scene::Sphere& sphere : scene.spheres) {
        require(sphere.radius > 0 && finite(sphere.center) && known(sphere.material));
    }
    for (const Scene::Cone& cone : scene.cones) {
        require(cone.base_radius >= 0 && cone.apex_radius >= 0 && cone.base != cone.apex);
        require(cone.base_radius + cone.apex_radius > 0 && known(cone.material));
    }
    for (const Scene::Triangle& triangle : scene.triangles) {
        for (const glm::dvec3& vertex : triangle.vertices) require(finite(vertex));
        require(known(triangle.material));
    }
    for (const Scene::Material& material : scene.materials) require(material.ior > 0);
}

inline void check_mesh(const Scene::Mesh& mesh, std::size_t materials) {
    require(!mesh.faces.empty());
    for (const glm::dvec3& position : mesh.positions) require(finite(position));
    for (const glm::dvec3& normal : mesh.normals) require(finite(normal));
    for (const auto& face : mesh.faces) {
        for (const std::uint32_t i : face) require(i < mesh.positions.size());
    }
    require(mesh.face_normals.empty() || mesh.face_normals.size() == mesh.faces.size());
    for (const auto& face : mesh.face_normals) {
        const bool flat = face[0] == Scene::Mesh::no_normal;
        for (const std::uint32_t i : face) {
            require(flat ? i == Scene::Mesh::no_normal : i < mesh.normals.size());
            if (!flat) require(std::abs(glm::dot(mesh.normals[i], mesh.normals[i]) - 1) < 1e-9);
        }
    }
    require(mesh.face_materials.size() == 1 || mesh.face_materials.size() == mesh.faces.size());
    for (const int material : mesh.face_materials) {
        require(material >= 0 && static_cast<std::size_t>(material) < materials);
    }
}

inline void render(Scene scene) {
    constexpr std::size_t most_primitives = 200;
    if (scene.spheres.size() + scene.cones.size() + triangle_count(scene) > most_primitives) return;
    constexpr int side = 8;
    set_image_size(scene, side, side);
    scene.aa = grid_aa(1);
    const FlatScene<float> flat = flatten<float>(scene);
    whole_film(*make_threads_renderer(flat, {1, Schedule::tiles}), side, side);
}

/// Runs a reader and renders its model alone and mirrored. Any bytes give either a picture or an
/// rt::Error that names a file.
template <typename Read>
void try_model(Read read) {
    bool is_read = false;
    try {
        const Model model = read();
        is_read = true;
        const Affine mirrored = make_affine({-2, 1, 3}, {10, 20, 30}, {1, 2, 3});
        for (const Affine& transform : {Affine{}, mirrored}) {
            Model finished = model;
            finish_mesh(finished.mesh, transform, "fuzz", finished.notes);
            const Scene scene = make_model_scene(std::move(finished), "fuzz");
            check_mesh(scene.meshes.at(0), scene.materials.size());
            render(scene);
        }
    } catch (const Error& error) {
        require(error.exit_code() == ExitCode::input || error.exit_code() == ExitCode::limit);
        require(is_read || std::string_view(error.what()).starts_with("fuzz."));
    }
}

}  // namespace rt::fuzz
