// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/render/adaptive.h"
#include "host/render/renderer.h"
#include "host/scene/aa_mode.h"

namespace rt {

/// Passes of refinement, and so how far away, in pixels, lies what an adaptive pixel depends on.
inline constexpr int refine_passes = 2;

/// The region to render so that `wanted`, a part of a picture of this size, has the pixels that it
/// has in the whole: for an adaptive mode more than the region itself.
Rect region_to_render(const AaMode& aa, const Rect& wanted, int picture_width, int picture_height);

/// What the owner of a picture hears of its refinement; each may be empty.
template <typename T>
struct RefineEvents {
    /// Before a pass, which counts from 0: pixels that it takes out of the plan are not refined.
    std::function<void(int pass, std::vector<Refinement>& plan, Film<T>& film)> planned;
    /// These pixels of the film are as the pass makes them.
    std::function<void(int pass, std::span<const std::int32_t> pixels)> refined;
};

/// Renders the queue's tiles and, for an adaptive mode, refines the picture until neighbors agree
/// or two passes are done. `region` is what the film shows of the picture. Returns whether it came
/// to the end: false when the queue was stopped with tiles left, or pixels to refine.
template <typename T>
bool render_all(Renderer<T>& renderer, const AaMode& aa, TileQueue& queue, const Rect& region,
                Film<T>& film, const RefineEvents<T>& events = {});

}  // namespace rt
