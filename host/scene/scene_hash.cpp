// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_hash.h"

#include "host/base/hash.h"

namespace rt {

namespace {

// Every struct is taken apart by a structured binding, so that a new member does not compile until
// somebody has decided whether it is part of the hash.

void add(Hasher& hasher, const glm::dvec3& v) {
    hasher.add(v.x);
    hasher.add(v.y);
    hasher.add(v.z);
}

void add(Hasher& hasher, const Scene::Window& window) {
    const auto& [left, right, bottom, top] = window;
    hasher.add(left);
    hasher.add(right);
    hasher.add(bottom);
    hasher.add(top);
}

void add(Hasher& hasher, const Scene::Camera& camera) {
    const auto& [projection, from, at, up, field_of_view, window] = camera;
    const auto& [fixed, amount] = field_of_view;
    hasher.add(static_cast<int>(projection));
    add(hasher, from);
    add(hasher, at);
    add(hasher, up);
    hasher.add(static_cast<int>(fixed));
    if (fixed == Scene::FieldOfView::Fixed::window) {
        add(hasher, window);
    } else {
        hasher.add(amount);
    }
}

void add(Hasher& hasher, const Scene::Material& material) {
    const auto& [name, ambient, diffuse, specular, mirror, transmission, shininess, ior,
                 two_sided] = material;
    add(hasher, ambient);
    add(hasher, diffuse);
    add(hasher, specular);
    add(hasher, mirror);
    add(hasher, transmission);
    hasher.add(shininess);
    hasher.add(ior);
    hasher.add(two_sided);
}

void add(Hasher& hasher, const Scene::Light& light) {
    const auto& [position, intensity, has_own_intensity] = light;
    add(hasher, position);
    add(hasher, intensity);
}

void add(Hasher& hasher, const Scene::Sphere& sphere) {
    const auto& [center, radius, material] = sphere;
    add(hasher, center);
    hasher.add(radius);
    hasher.add(material);
}

void add(Hasher& hasher, const Scene::Triangle& triangle) {
    const auto& [vertices, normals, material] = triangle;
    for (const auto& vertex : vertices) add(hasher, vertex);
    hasher.add(normals.has_value());
    if (normals) {
        for (const auto& normal : *normals) add(hasher, normal);
    }
    hasher.add(material);
}

void add(Hasher& hasher, const Scene::Cone& cone) {
    const auto& [base, apex, base_radius, apex_radius, material] = cone;
    add(hasher, base);
    add(hasher, apex);
    hasher.add(base_radius);
    hasher.add(apex_radius);
    hasher.add(material);
}

void add(Hasher& hasher, const Scene::Mesh::Face& face) {
    for (const std::uint32_t index : face) hasher.add(index);
}

void add(Hasher& hasher, int index) { hasher.add(index); }

void add(Hasher& hasher, const Scene::Mesh& mesh);

template <typename Item>
void add_all(Hasher& hasher, const std::vector<Item>& items) {
    hasher.add(items.size());
    for (const Item& item : items) add(hasher, item);
}

void add(Hasher& hasher, const Scene::Mesh& mesh) {
    const auto& [positions, normals, faces, face_normals, face_materials] = mesh;
    add_all(hasher, positions);
    add_all(hasher, normals);
    add_all(hasher, faces);
    add_all(hasher, face_normals);
    add_all(hasher, face_materials);
}

void add_shapes(Hasher& hasher, const Scene& scene) {
    add_all(hasher, scene.spheres);
    add_all(hasher, scene.cones);
    add_all(hasher, scene.triangles);
    add_all(hasher, scene.meshes);
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    const auto& [name, camera, path, width, height, aa, filter, sampling_seed, max_bounces,
                 background, ambient_light, lights, materials, spheres, cones, triangles, meshes,
                 notes, model_files] = scene;
    Hasher hasher;
    add(hasher, camera);
    add(hasher, background);
    add(hasher, ambient_light);
    add_all(hasher, lights);
    add_all(hasher, materials);
    add_shapes(hasher, scene);
    return hasher.value();
}

std::uint64_t shapes_hash(const Scene& scene) {
    Hasher hasher;
    add_shapes(hasher, scene);
    return hasher.value();
}

}  // namespace rt
