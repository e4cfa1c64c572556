// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rt {

/// What a scene needs from the kernels; the switches of kernels/features.h. Coarse and few: a test
/// builds and renders each alone, each pair, and all but each one.
struct Features {
    bool spheres = true;
    bool huge_spheres = true;    ///< far larger than their distance; implies spheres
    bool eye_on_surface = true;  ///< the eye lies on a sphere, a cone or in a triangle's plane
    bool cones = true;
    bool triangles = true;
    bool vertex_normals = true;  ///< implies triangles
    bool hierarchy = true;       ///< some kind of primitive is found through boxes
    bool lights = true;          ///< shadow rays, diffuse and specular light
    bool mirrors = true;         ///< the bounce loop
    bool glass = true;           ///< refracted rays, and with mirrors the stack of a ray tree
    bool sobol = true;           ///< scattered samples; else a regular grid's
    bool filters = true;         ///< samples with unequal weights
    bool edges = true;           ///< signatures of ray trees, samples on lines

    bool operator==(const Features&) const = default;
};

/// One switch: its name for people and for the kernels' build options.
struct FeatureName {
    bool Features::*flag;
    const char* name;
    const char* macro;
};

inline constexpr std::array<FeatureName, 13> feature_names{{
    {&Features::spheres, "spheres", "RT_HAS_SPHERES"},
    {&Features::huge_spheres, "huge spheres", "RT_HAS_HUGE_SPHERES"},
    {&Features::eye_on_surface, "eye on a surface", "RT_HAS_EYE_ON_SURFACE"},
    {&Features::cones, "cones", "RT_HAS_CONES"},
    {&Features::triangles, "triangles", "RT_HAS_TRIANGLES"},
    {&Features::vertex_normals, "vertex normals", "RT_HAS_VERTEX_NORMALS"},
    {&Features::hierarchy, "hierarchy", "RT_HAS_HIERARCHY"},
    {&Features::lights, "lights", "RT_HAS_LIGHTS"},
    {&Features::mirrors, "mirrors", "RT_HAS_MIRRORS"},
    {&Features::glass, "glass", "RT_HAS_GLASS"},
    {&Features::sobol, "Sobol samples", "RT_HAS_SOBOL"},
    {&Features::filters, "wide filters", "RT_HAS_FILTERS"},
    {&Features::edges, "edges", "RT_HAS_EDGES"},
}};

/// No features.
Features no_features();

/// The features whose bits are set: the first of feature_names is bit 0 (RT_FEATURE_BITS).
Features features_of(int bits);

/// The union of both.
Features either_of(const Features& a, const Features& b);

/// The names of the switches that are on (used) or off (left out).
std::vector<std::string> names_of(const Features& features, bool used);

}  // namespace rt
