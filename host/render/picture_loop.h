// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/renderer.h"
#include "host/scene/aa_mode.h"

namespace rt {

/// Renders the queue's tiles and, for an adaptive mode, refines the picture until neighbours agree
/// or two passes are done. `region` is what the film shows of the picture. Stops early, with every
/// pixel sampled at least once, when the queue is stopped after the tiles.
template <typename T>
void render_all(Renderer<T>& renderer, const AaMode& aa, TileQueue& queue, const Rect& region,
                Film<T>& film);

}  // namespace rt
