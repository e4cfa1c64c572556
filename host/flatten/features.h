// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>
#include <vector>

namespace rt {

/// What a scene can need from the kernels: the bits of kernels/features.h. Coarse and few: tests
/// render each alone, and every set that a scene can need.
namespace feature {
enum Index : std::size_t {
    spheres,
    huge_spheres,    ///< far larger than their distance; implies spheres
    eye_on_surface,  ///< the eye lies on a sphere, a cone or in a triangle's plane
    cones,
    triangles,
    vertex_normals,  ///< implies triangles
    hierarchy,       ///< some kind of primitive is found through boxes
    lights,          ///< shadow rays, diffuse and specular light
    mirrors,         ///< the bounce loop
    glass,           ///< refracted rays, and with mirrors the stack of a ray tree
    sobol,           ///< scattered samples; else a regular grid's
    filters,         ///< samples with unequal weights
    edges,           ///< signatures of ray trees, samples on lines
};
}  // namespace feature

inline constexpr std::array<const char*, 13> feature_names{
    "spheres",   "huge spheres", "eye on a surface", "cones", "triangles",     "vertex normals",
    "hierarchy", "lights",       "mirrors",          "glass", "Sobol samples", "wide filters",
    "edges",
};

using Features = std::bitset<feature_names.size()>;

inline constexpr Features every_feature{(1u << feature_names.size()) - 1};

/// The names of the switches that are on (used) or off (left out).
inline std::vector<std::string> names_of(const Features& features, bool used) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < features.size(); ++i) {
        if (features[i] == used) names.emplace_back(feature_names[i]);
    }
    return names;
}

}  // namespace rt
