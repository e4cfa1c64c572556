// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"
#include "host/stress/stress_case.h"

namespace rt {

// Trials that send rays through a renderer, in the arithmetic of T; the same rays each time.

enum class RayAim { edges, vertices };

/// Rays from near the center of a closed, star-shaped mesh to points on its edges or to its
/// vertices. A failure is a ray that hits nothing.
template <typename T>
RayFigures count_leaks(const Scene& mesh, RayAim aim, std::uint64_t rays, const RayCaster& caster);

enum class MeshSide { inside, outside };

/// Rays to points within 64 u of the edges and vertices of a closed, convex mesh, from steep down
/// to a slope of 1e-6 against one of the faces there, and secondary rays from there. From inside,
/// they must meet the mesh; from outside, they must not.
template <typename T>
RayFigures count_edge_escapes(const Scene& mesh, MeshSide side, std::uint64_t rays,
                              const RayCaster& caster);

/// Rays from the eye to the scene's first sphere, and secondary rays from there: outwards, from
/// steep down to 1e-6 rad above the surface, which must not hit it again; inwards, down to
/// `shallowest` rad, which must find its far side within 0.1 %.
template <typename T>
RayFigures count_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                  const RayCaster& caster);

/// Rays from the eye past the scene's first sphere, within 1.5 times its apparent radius. A failure
/// is a ray whose hit or miss differs from quad arithmetic on the same rounded numbers; the error
/// is that of the distance.
template <typename T>
RayFigures count_sphere_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster);

/// As count_leaving_failures, from the scene's first cone. Inwards, rays that return within a
/// thousandth of the length of a rim do not count; the others must miss, or find the far side
/// within 1 %, as exact arithmetic does.
template <typename T>
RayFigures count_cone_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                       const RayCaster& caster);

/// As count_sphere_failures, past the scene's first cone and its rims.
template <typename T>
RayFigures count_cone_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster);

}  // namespace rt
