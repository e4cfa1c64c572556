// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_hash.h"

#include "host/hash.h"

namespace rt {

namespace {

void add(Hasher& hasher, const glm::dvec3& v) {
    hasher.add(v.x);
    hasher.add(v.y);
    hasher.add(v.z);
}

void add(Hasher& hasher, const Scene::Camera& camera) {
    hasher.add(static_cast<int>(camera.projection));
    add(hasher, camera.from);
    add(hasher, camera.at);
    add(hasher, camera.up);
    hasher.add(static_cast<int>(camera.field_of_view.fixed));
    if (camera.field_of_view.fixed != Scene::FieldOfView::Fixed::window) {
        hasher.add(camera.field_of_view.amount);
        return;
    }
    hasher.add(camera.window.left);
    hasher.add(camera.window.right);
    hasher.add(camera.window.bottom);
    hasher.add(camera.window.top);
}

void add(Hasher& hasher, const Scene::Material& material) {
    add(hasher, material.ambient);
    add(hasher, material.diffuse);
    add(hasher, material.specular);
    add(hasher, material.mirror);
    add(hasher, material.transmission);
    hasher.add(material.shininess);
    hasher.add(material.ior);
    hasher.add(material.two_sided);
}

void add(Hasher& hasher, const Scene::Light& light) {
    add(hasher, light.position);
    add(hasher, light.intensity);
}

void add(Hasher& hasher, const Scene::Sphere& sphere) {
    add(hasher, sphere.center);
    hasher.add(sphere.radius);
    hasher.add(sphere.material);
}

void add(Hasher& hasher, const Scene::Triangle& triangle) {
    for (const auto& vertex : triangle.vertices) add(hasher, vertex);
    hasher.add(triangle.normals.has_value());
    if (triangle.normals) {
        for (const auto& normal : *triangle.normals) add(hasher, normal);
    }
    hasher.add(triangle.material);
}

void add(Hasher& hasher, const Scene::Cone& cone) {
    add(hasher, cone.base);
    add(hasher, cone.apex);
    hasher.add(cone.base_radius);
    hasher.add(cone.apex_radius);
    hasher.add(cone.material);
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
    add_all(hasher, mesh.positions);
    add_all(hasher, mesh.normals);
    add_all(hasher, mesh.faces);
    add_all(hasher, mesh.face_normals);
    add_all(hasher, mesh.face_materials);
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    Hasher hasher;
    add(hasher, scene.camera);
    add(hasher, scene.background);
    add(hasher, scene.ambient_light);
    add_all(hasher, scene.lights);
    add_all(hasher, scene.materials);
    add_all(hasher, scene.spheres);
    add_all(hasher, scene.cones);
    add_all(hasher, scene.triangles);
    add_all(hasher, scene.meshes);
    return hasher.value();
}

}  // namespace rt
