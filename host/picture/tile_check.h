// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/render/renderer.h"

namespace rt {

/// Renders four strips across the picture on the device and on threads. Throws Error
/// (ExitCode::device) unless the bits are the same: the driver, or the kernel it keeps in its
/// cache, is broken. Strict arithmetic only. About 33,000 samples, a millisecond or two.
template <typename T>
void self_test(Renderer<T>& device, const std::string& name, const FlatScene<T>& scene,
               const std::string& isa);

/// Describes a ray count too high for so many lights and bounces, which a device must have
/// miscounted; empty if it is possible. A path has at most one ray per bounce, with glass a binary
/// tree; every surface at most one shadow ray per light. Interrupted pictures may have counted
/// more.
std::string impossible_rays(const RayCounts& rays, std::size_t lights, int max_bounces,
                            bool has_glass);

/// The result of tracing part of a finished picture again on threads.
struct TileCheck {
    std::size_t tiles = 0;
    std::size_t wrong_tiles = 0;  ///< with different bits
};

/// Traces `share` (0 to 1) of the tiles again, at least one, spread over the region that the film
/// shows, and other ones each time; the tiles lie in it.
template <typename T>
TileCheck check_tiles(const FlatScene<T>& scene, const std::string& isa,
                      const std::vector<Rect>& tiles, double share, const Rect& region,
                      const Film<T>& film);

}  // namespace rt
