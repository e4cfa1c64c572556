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

struct TracedPicture {
    std::vector<float> rgb;  ///< row 0 at the top
    RayCounts rays;
    double seconds = 0;
};

/// Renders the picture of the flat scene: mirrorball's eye rays, samples and shading, Embree's
/// hits.
TracedPicture trace(const rt::FlatScene<float>& flat, const EmbreeScene& embree, Mode mode,
                    int threads);

}  // namespace embree_bench
