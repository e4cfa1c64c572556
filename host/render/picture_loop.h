// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/render/adaptive.h"
#include "host/render/renderer.h"
#include "host/scene/aa_mode.h"

namespace rt {

/// Refinement passes, and so how many pixels away an adaptive pixel's dependencies reach.
inline constexpr int refine_passes = 2;

/// The region to render so that `wanted`, part of a picture of this size, has the same pixels as in
/// the whole: adaptive modes need a margin.
Rect region_to_render(const AaMode& aa, const Rect& wanted, int picture_width, int picture_height);

/// Events for a picture's owner during refinement; each may be empty.
template <typename T>
struct RefineEvents {
    /// Before each pass, counting from 0: pixels removed from the plan are not refined.
    std::function<void(int pass, std::vector<Refinement>& plan, Film<T>& film)> planned;
    /// The pass has finished these pixels of the film.
    std::function<void(int pass, std::span<const std::int32_t> pixels)> refined;
};

struct RenderedAll {
    bool is_finished = false;  ///< false: stopped with tiles left, or pixels to refine
    double plan_seconds = 0;   ///< to choose what to refine: part of no renderer's times
};

/// Renders the queue's tiles and, for an adaptive mode, refines the picture until neighbors agree
/// or two passes are done. `region` is what the film shows of the picture.
template <typename T>
RenderedAll render_all(Renderer<T>& renderer, const AaMode& aa, TileQueue& queue,
                       const Rect& region, Film<T>& film, const RefineEvents<T>& events = {});

}  // namespace rt
