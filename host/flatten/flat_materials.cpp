// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_materials.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "host/flatten/flat_shapes.h"

namespace rt {

namespace {

/// Which materials are used by some primitive.
std::vector<bool> worn_materials(const Scene& scene) {
    std::vector<bool> worn(scene.materials.size(), false);
    const auto wear = [&](int material) { worn[static_cast<std::size_t>(material)] = true; };
    for (const auto& sphere : scene.spheres) wear(sphere.material);
    for (const auto& cone : scene.cones) wear(cone.material);
    for (const auto& triangle : scene.triangles) wear(triangle.material);
    for (const auto& mesh : scene.meshes) {
        for (const int material : mesh.face_materials) wear(material);
    }
    return worn;
}

/// Rounded, but not to 0, nor to a number whose reciprocal is infinite.
template <typename T>
T round_positive(double x) {
    return std::max(static_cast<T>(x), std::numeric_limits<T>::min());
}

}  // namespace

template <typename T>
typename Flat<T>::Material flatten_material(const Scene::Material& material) {
    typename Flat<T>::Material flat{};
    flat.ambient = pack<T>(material.ambient);
    flat.shininess = material.shininess == 0 ? T(0) : round_positive<T>(material.shininess);
    flat.diffuse = pack<T>(material.diffuse);
    flat.two_sided = material.two_sided ? 1 : 0;
    flat.specular = pack<T>(material.specular);
    flat.ior = round_positive<T>(material.ior);
    flat.mirror = pack<T>(material.mirror);
    flat.transmission = pack<T>(material.transmission);
    return flat;
}

MaterialUse material_use(const Scene& scene) {
    MaterialUse use;
    const std::vector<bool> worn = worn_materials(scene);
    for (std::size_t i = 0; i < worn.size(); ++i) {
        if (!worn[i]) continue;
        const Scene::Material& material = scene.materials[i];
        const bool mirrors = !is_black(material.mirror);
        const bool transmits = !is_black(material.transmission);
        use.reflects_lights |= !is_black(material.diffuse) || !is_black(material.specular);
        use.mirrors |= mirrors;
        use.transmits |= transmits;
        use.splits |= mirrors && transmits;
    }
    return use;
}

template f32::Material flatten_material<float>(const Scene::Material&);
template f64::Material flatten_material<double>(const Scene::Material&);

}  // namespace rt
