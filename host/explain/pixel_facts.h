// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/render/rect.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene.h"

namespace rt {

/// What the eye ray through each pixel's center hits, row by row. In double, whatever the picture's
/// precision.
struct PixelHits {
    std::vector<float> depth;   ///< distance along the eye ray, in scene units; 0: nothing
    std::vector<float> normal;  ///< of unit length, on the side that lights see; three numbers each
    std::vector<std::int32_t> id;  ///< of the primitive, from 1 (number_in_scene); 0: nothing
};

/// For the pixels of a region; for some of them if the stop flag is set.
PixelHits pixel_hits(const Scene& scene, const Rect& region, const StopFlag& stop);

/// The work per pixel, row by row. The rays add up to the picture's.
struct PixelWork {
    std::vector<std::uint32_t> samples;
    std::vector<std::uint64_t> rays;  ///< eye, shadow, mirror and refracted rays
};

/// For the pixels of a region, as rendered in the precision of T. For some of them if the stop flag
/// is set.
template <typename T>
PixelWork pixel_work(const Scene& scene, const Rect& region, const StopFlag& stop);

}  // namespace rt
