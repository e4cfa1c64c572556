// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"
#include "host/stress/ray_caster.h"
#include "host/stress/stress_case.h"

namespace rt {

// Rays through a renderer, in the arithmetic of T; the same ones each time.

enum class RayAim { edges, vertices };

/// Rays from around the middle of a closed mesh, star-shaped about it, at points on its edges or at
/// its vertices. A failure is one that hits nothing.
template <typename T>
RayFigures count_leaks(const Scene& mesh, RayAim aim, std::uint64_t rays, const RayCaster& caster);

/// Rays from the eye to the scene's first sphere, and on from there: outwards, from steep to 1e-6
/// rad over the surface, which must not hit it again; inwards, to `shallowest` rad, which must find
/// its far side within 0.1 %.
template <typename T>
RayFigures count_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                  const RayCaster& caster);

/// Rays from the eye past the scene's first sphere, within 1.5 times its apparent radius. A failure
/// is one that hits or misses where quad arithmetic on the same rounded numbers says otherwise; the
/// error is that of the distance.
template <typename T>
RayFigures count_sphere_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster);

/// As count_leaving_failures, from the scene's first cone. Inwards, the far side counts where it
/// lies clear of the rims by a thousandth of the length, and so does that there is none; it must be
/// found within 1 %.
template <typename T>
RayFigures count_cone_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                       const RayCaster& caster);

/// As count_sphere_failures, past the scene's first cone and its rims.
template <typename T>
RayFigures count_cone_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster);

}  // namespace rt
