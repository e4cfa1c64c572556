// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/flatten/flat_types.h"
#include "host/render/native_kernels.h"
#include "host/render/packet_shape.h"

namespace rt {

/// As many pixels as a tile and those around it that an edges mode looks at, too
/// (kernels/edges.cl).
template <typename FlatTile>
FlatTile size_with_margin(FlatTile tile, int margin = f32::RT_EDGE_MARGIN) {
    tile.width += 2 * margin;
    tile.height += 2 * margin;
    return tile;
}

/// How many numbers the kernels keep of it.
template <typename FlatTile>
std::size_t edge_plane_values(const FlatTile& tile, int lanes) {
    constexpr int planes = 4 + f32::RT_EDGE_MARGIN - 1;  // the centers, and states of each round
    const FlatTile wide = size_with_margin(tile);
    return static_cast<std::size_t>(planes * (wide.width * wide.height + lanes));
}

/// A guess of a pixel's samples, for how much to do at a time.
inline constexpr int edge_samples_guess = 8;

/// Renders a tile of an edges mode on this thread; false if stopped before the last pixel. `planes`
/// is scratch memory. Counts the rays, but not the samples at the pixels' centers.
template <typename T, typename IsStopped>
bool render_edge_tile(const NativeKernels<T>& kernels, const NativeView<T>& view,
                      const typename Flat<T>::Tile& tile, std::vector<T>& planes, T* film,
                      typename Flat<T>::RayCounts& counts, const IsStopped& is_stopped) {
    using Index = typename Flat<T>::Index;
    const auto wide = size_with_margin(tile);
    const PacketShape shape = packet_shape(kernels.lanes, 1);
    const Index packets = (wide.width + shape.width - 1) / shape.width;
    planes.resize(edge_plane_values(tile, kernels.lanes));
    for (Index row = 0; row * shape.height < wide.height; ++row) {
        if (is_stopped()) return false;
        kernels.render_centers(planes.data(), &counts, &view, &tile, row * packets,
                               (row + 1) * packets);
    }
    for (int round = 0; round < f32::RT_EDGE_MARGIN; ++round) {
        const auto seen = size_with_margin(tile, f32::RT_EDGE_MARGIN - 1 - round);
        const Index across = (seen.width + kernels.lanes - 1) / kernels.lanes;
        for (Index row = 0; row < seen.height; ++row) {
            if (is_stopped()) return false;
            kernels.render_edges(film, &counts, &view, &tile, planes.data(), round, row * across,
                                 (row + 1) * across);
        }
    }
    return true;
}

}  // namespace rt
