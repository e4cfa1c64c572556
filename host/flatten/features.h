// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>
#include <vector>

namespace rt {

/// What a scene can need from the kernels: the switches of kernels/features.h, in the order of its
/// RT_FEATURE_BITS. Coarse and few: tests render each alone, and every set that a scene can
/// need.
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

/// One switch: its name for people and for the kernels' build options.
struct FeatureName {
    const char* name;
    const char* macro;
};

inline constexpr std::array<FeatureName, 13> feature_names{{
    {"spheres", "RT_HAS_SPHERES"},
    {"huge spheres", "RT_HAS_HUGE_SPHERES"},
    {"eye on a surface", "RT_HAS_EYE_ON_SURFACE"},
    {"cones", "RT_HAS_CONES"},
    {"triangles", "RT_HAS_TRIANGLES"},
    {"vertex normals", "RT_HAS_VERTEX_NORMALS"},
    {"hierarchy", "RT_HAS_HIERARCHY"},
    {"lights", "RT_HAS_LIGHTS"},
    {"mirrors", "RT_HAS_MIRRORS"},
    {"glass", "RT_HAS_GLASS"},
    {"Sobol samples", "RT_HAS_SOBOL"},
    {"wide filters", "RT_HAS_FILTERS"},
    {"edges", "RT_HAS_EDGES"},
}};

using Features = std::bitset<feature_names.size()>;

inline constexpr Features every_feature{(1u << feature_names.size()) - 1};

/// The names of the switches that are on (used) or off (left out).
inline std::vector<std::string> names_of(const Features& features, bool used) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < features.size(); ++i) {
        if (features[i] == used) names.emplace_back(feature_names[i].name);
    }
    return names;
}

}  // namespace rt
