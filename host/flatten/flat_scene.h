// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/flatten/bvh.h"
#include "host/flatten/features.h"
#include "host/flatten/flat_types.h"
#include "host/scene/scene.h"

namespace rt {

/// A kind with fewer primitives than this has no hierarchy: a ray tests each of them.
inline constexpr std::size_t bvh_crossover = 24;

/// The primitives of one kind, and the hierarchy over them; all 0 if there is none.
struct KindStats {
    const char *one = "", *many = "";  ///< "sphere", "spheres"
    std::size_t count = 0;
    BvhShape hierarchy{};
};

/// What flatten built.
struct FlattenStats {
    KindStats spheres{"sphere", "spheres"}, cones{"cone", "cones"},
        triangles{"triangle", "triangles"};  ///< those of meshes included
    double bvh_seconds = 0;
    std::uint64_t casters = 0;        ///< pairs of a light and a triangle that may cast its shadow
    std::uint64_t lit_triangles = 0;  ///< all pairs of a light and a triangle

    std::array<KindStats, 3> kinds() const { return {spheres, cones, triangles}; }
};

/// A scene as arrays of shared structs in the renderer's frame, in the precision of T (float or
/// double): everything a renderer reads, and nothing else. Primitives are numbered spheres first,
/// then cones, then triangles.
template <typename T>
struct FlatScene {
    std::vector<typename Flat<T>::Sphere> spheres;
    std::vector<typename Flat<T>::Cone> cones;
    HugeVector<typename Flat<T>::Triangle> triangles;
    std::vector<typename Flat<T>::VertexNormals> vertex_normals;
    std::vector<typename Flat<T>::Material> materials;
    std::vector<typename Flat<T>::Light> lights;
    /// Hierarchies over the kinds of primitive that have one (LaunchParams::..._root). Leaves index
    /// a kind's primitives from 0.
    HugeVector<typename Flat<T>::BvhNode> nodes;
    /// Each primitive's number in the author's order: ties go to the lowest. Empty if the arrays
    /// are in that order, for lack of a hierarchy.
    std::vector<typename Flat<T>::Index> order;
    /// Each light's triangles that may cast a shadow (Light::first_caster, caster_count), as
    /// indices into `triangles`, ascending. A light that counts all triangles has no list.
    std::vector<typename Flat<T>::Index> casters;
    typename Flat<T>::LaunchParams params;
    Features features;
    FlattenStats stats;

    std::size_t bytes() const;
};

struct FlattenOptions {
    int threads = 0;  ///< 0: all cores; does not affect the result
    /// Which kinds get a hierarchy: those with enough primitives (unset), any with two (true), or
    /// none (false).
    std::optional<bool> hierarchies;
    bool caster_lists = true;  ///< false: every triangle casts shadows
};

/// Flattens a scene with its picture size, sampling and bounce limit. Lights that shine on nothing
/// are left out. Throws Error (ExitCode::input) if something lies too far away for T,
/// (ExitCode::limit) if there is more than can be numbered or than fits into memory.
template <typename T>
FlatScene<T> flatten(const Scene& scene, const FlattenOptions& options = {});

}  // namespace rt
