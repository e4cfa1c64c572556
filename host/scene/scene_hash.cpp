// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <type_traits>
#include <vector>

#include "host/base/hash.h"
#include "host/scene/scene.h"

namespace rt {
namespace {

// Every struct is taken apart by a structured binding, so that a new member does not compile until
// somebody has decided whether it is part of the hash.
class SceneHasher {
   public:
    template <typename... Parts>
    void add(const Parts&... parts) {
        (add_one(parts), ...);
    }

    std::uint64_t value() const { return hasher_.value(); }

   private:
    template <typename N>
    requires(std::is_arithmetic_v<N> || std::is_enum_v<N>) void add_one(N number) {
        if constexpr (std::is_enum_v<N>) {
            hasher_.add(static_cast<int>(number));
        } else {
            hasher_.add(number);
        }
    }
    template <typename Item>
    void add_one(const std::vector<Item>& items) {
        hasher_.add(items.size());
        for (const Item& item : items) add_one(item);
    }
    template <typename Item>
    void add_one(const std::array<Item, 3>& items) {
        for (const Item& item : items) add_one(item);
    }
    void add_one(const glm::dvec3& v) { add(v.x, v.y, v.z); }

    void add_one(const Scene::Camera& camera) {
        const auto& [projection, from, at, up, field_of_view, window] = camera;
        const auto& [fixed, amount] = field_of_view;
        const auto& [left, right, bottom, top] = window;
        add(projection, from, at, up, fixed);
        if (fixed == Scene::FieldOfView::Fixed::window) {
            add(left, right, bottom, top);
        } else {
            add(amount);
        }
    }
    void add_one(const Scene::Material& material) {
        const auto& [name, ambient, diffuse, specular, mirror, transmission, shininess, ior,
                     two_sided] = material;
        add(ambient, diffuse, specular, mirror, transmission, shininess, ior, two_sided);
    }
    void add_one(const Scene::Light& light) {
        const auto& [position, intensity, has_own_intensity] = light;
        add(position, intensity);
    }
    void add_one(const Scene::Sphere& sphere) {
        const auto& [center, radius, material] = sphere;
        add(center, radius, material);
    }
    void add_one(const Scene::Triangle& triangle) {
        const auto& [vertices, normals, material] = triangle;
        add(vertices, normals.has_value());
        if (normals) add(*normals);
        add(material);
    }
    void add_one(const Scene::Cone& cone) {
        const auto& [base, apex, base_radius, apex_radius, material] = cone;
        add(base, apex, base_radius, apex_radius, material);
    }
    void add_one(const Scene::Mesh& mesh) {
        const auto& [positions, normals, faces, face_normals, face_materials] = mesh;
        add(positions, normals, faces, face_normals, face_materials);
    }

    Hasher hasher_;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    const auto& [name, camera, path, width, height, aa, filter, sampling_seed, max_bounces,
                 background, ambient_light, lights, materials, spheres, cones, triangles, meshes,
                 notes, model_files] = scene;
    SceneHasher hasher;
    hasher.add(camera, background, ambient_light, lights, materials, spheres, cones, triangles,
               meshes);
    return hasher.value();
}

}  // namespace rt
