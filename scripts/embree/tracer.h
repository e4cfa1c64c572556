// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "scripts/embree/embree_scene.h"

namespace embree_bench {

/// What Embree is told of the rays after a mirror, which it gets in packets, as all others.
/// Eye rays and their shadow rays are coherent.
enum class MirrorRays { coherent, incoherent };

struct RayCounts {
    std::uint64_t primary = 0, shadow = 0, mirror = 0;

    RayCounts& operator+=(const RayCounts& other);
    std::uint64_t total() const { return primary + shadow + mirror; }
};

struct TracedPicture {
    std::vector<float> rgb;  ///< row 0 at the top
    RayCounts rays;
    double seconds = 0;
};

/// Renders the picture of the flat scene: mirrorball's eye rays, samples and shading, Embree's
/// hits.
TracedPicture trace(const rt::FlatScene<float>& flat, const EmbreeScene& embree,
                    MirrorRays mirror_rays, int threads);

}  // namespace embree_bench
