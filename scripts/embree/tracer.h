// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "scripts/embree/embree_scene.h"

namespace embree_bench {

/// How Embree is asked: packets of 16 rays, called coherent or incoherent; coherent but for mirror
/// rays; or one ray after the other.
enum class Mode { coherent, incoherent, mixed, single };

struct RayCounts {
    std::uint64_t primary = 0, shadow = 0, mirror = 0;

    RayCounts& operator+=(const RayCounts& other);
    std::uint64_t total() const { return primary + shadow + mirror; }
};

/// What a picture takes when each ray tests each primitive (shadow rays: each caster, up to the
/// first that blocks it).
struct WorkCounts {
    std::uint64_t sphere_tests = 0, triangle_tests = 0;
    std::uint64_t rays = 0, shadow_rays = 0, hits = 0, hits_by_lights = 0, lit = 0, shiny = 0;

    WorkCounts& operator+=(const WorkCounts& other);
    double flops() const;
};

struct TracedPicture {
    std::vector<float> rgb;  ///< row 0 at the top
    RayCounts rays;
    WorkCounts work;  ///< where that was asked for
    double seconds = 0;
};

/// Renders the picture of the flat scene: mirrorball's eye rays, samples and shading, Embree's
/// hits.
TracedPicture trace(const rt::FlatScene<float>& flat, const EmbreeScene& embree, Mode mode,
                    int threads, bool count_work = false);

}  // namespace embree_bench
