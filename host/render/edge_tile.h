// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/flatten/flat_types.h"
#include "host/render/native_kernels.h"
#include "host/render/packet_shape.h"

namespace rt {

/// A tile with the pixels around it that an edges mode looks at, too (kernels/edges.cl).
template <typename FlatTile>
FlatTile with_margin(FlatTile tile, int margin = f32::RT_EDGE_MARGIN) {
    tile.width += 2 * margin;
    tile.height += 2 * margin;
    return tile;
}

/// How many numbers the kernels keep of it.
template <typename FlatTile>
std::size_t edge_plane_values(const FlatTile& tile, int lanes) {
    const FlatTile wide = with_margin(tile);
    return static_cast<std::size_t>((3 + f32::RT_EDGE_MARGIN) * (wide.width * wide.height + lanes));
}

/// Renders a tile of an edges mode on this thread; false if stopped before the last pixel. `planes`
/// is scratch memory. Counts the rays, but not the samples at the pixels' centers.
template <typename T, typename IsStopped>
bool render_edge_tile(const NativeKernels<T>& kernels, const NativeView<T>& view,
                      const typename Flat<T>::Tile& tile, std::vector<T>& planes, T* film,
                      typename Flat<T>::RayCounts& counts, const IsStopped& is_stopped) {
    using Index = typename Flat<T>::Index;
    const auto wide = with_margin(tile);
    const PacketShape shape = packet_shape(kernels.lanes, 1);
    const Index packets = ((wide.width + shape.width - 1) / shape.width) *
                          ((wide.height + shape.height - 1) / shape.height);
    planes.resize(edge_plane_values(tile, kernels.lanes));
    kernels.render_centers(planes.data(), &counts, &view, &tile, 0, packets);
    for (int round = 0; round < f32::RT_EDGE_MARGIN; ++round) {
        const auto seen = with_margin(tile, f32::RT_EDGE_MARGIN - 1 - round);
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
