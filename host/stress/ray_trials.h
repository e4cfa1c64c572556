// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"
#include "host/stress/stress_case.h"

namespace rt {

// Trials that send rays through a renderer; the same rays each time.

enum class RayAim { edges, vertices };

/// Rays from near the center of a closed, star-shaped mesh to points on its edges or to its
/// vertices. A failure is a ray that hits nothing.
RayTrial leaks(const Scene& mesh, RayAim aim);

enum class MeshSide { inside, outside };

/// Rays to points within 64 u of the edges and vertices of a closed, convex mesh, from steep down
/// to a slope of 1e-6 against one of the faces there, and secondary rays from there. From inside,
/// they must meet the mesh; from outside, they must not.
RayTrial edge_escapes(const Scene& mesh, MeshSide side);

/// Rays from the eye to the scene's first sphere, and secondary rays from there: outwards, from
/// steep down to 1e-6 rad above the surface, which must not hit it again; inwards, down to
/// `shallowest` rad, which must find its far side within 0.1 %.
RayTrial leaving_sphere(const Scene& scene, double shallowest);

/// Rays from the eye past the scene's first sphere, within 1.5 times its apparent radius. A failure
/// is a ray whose hit or miss differs from quad arithmetic on the same rounded numbers; the error
/// is that of the distance.
RayTrial past_sphere(const Scene& scene);

/// As leaving_sphere, from the scene's first cone. Inwards, rays that return within a
/// thousandth of the length of a rim do not count; the others must miss, or find the far side
/// within 1 %, as exact arithmetic does.
RayTrial leaving_cone(const Scene& scene, double shallowest);

/// As past_sphere, past the scene's first cone and its rims.
RayTrial past_cone(const Scene& scene);

}  // namespace rt
