// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "host/flatten/flat_types.h"
#include "host/scene/scene.h"

namespace rt {

inline bool is_black(const glm::dvec3& color) { return color == glm::dvec3(0); }

template <typename T>
typename Flat<T>::Material flatten_material(const Scene::Material& material);

/// What the materials used by some primitive do with light.
struct MaterialUse {
    bool reflects_lights = false;  ///< one is diffuse or specular
    bool mirrors = false, transmits = false;
    bool splits = false;  ///< one both mirrors and transmits
};

MaterialUse material_use(const Scene& scene);

}  // namespace rt
