// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "host/flatten/flat_types.h"
#include "host/render/native_kernels.h"

// The packets of a tile, and rounds over it: adaptive and edges modes render a tile in rounds, with
// pixels around it (kernels/planes.cl).
namespace rt {

/// How a packet's lanes are divided among pixels and samples, as in make_packet of
/// kernels/packet.cl.
struct PacketShape {
    int samples = 1;            ///< of each pixel
    int width = 1, height = 1;  ///< of the block of pixels

    int pixels() const { return width * height; }
};

inline PacketShape packet_shape(int lanes, int samples_of_a_pixel) {
    PacketShape shape;
    while (2 * shape.samples <= std::min<int>(lanes, f32::RT_SAMPLES_TOGETHER) &&
           samples_of_a_pixel % (2 * shape.samples) == 0) {
        shape.samples *= 2;
    }
    for (int pixels = lanes / shape.samples; pixels > 1; pixels /= 2) {
        (shape.width > shape.height ? shape.height : shape.width) *= 2;
    }
    return shape;
}

template <typename Params>
bool renders_in_rounds(const Params& params) {
    return params.tolerance > 0 || params.threshold > 0;
}

/// Pixels around a tile that its own depend on, and rounds.
template <typename Params>
int tile_margin(const Params& params) {
    return params.tolerance > 0 ? f32::RT_EDGE_MARGIN : f32::RT_ADAPTIVE_MARGIN;
}

/// Rounds after the one sample per pixel.
template <typename Params>
int round_count(const Params& params) {
    return params.tolerance > 0 ? f32::RT_EDGE_ROUNDS : f32::RT_ADAPTIVE_MARGIN;
}

/// As many pixels as a tile and those around it.
template <typename FlatTile>
FlatTile size_with_margin(FlatTile tile, int margin) {
    tile.width += 2 * margin;
    tile.height += 2 * margin;
    return tile;
}

/// How many numbers the kernels keep of a tile.
template <typename Params, typename FlatTile>
std::size_t plane_values(const Params& params, const FlatTile& tile, int lanes) {
    // The centers with their signatures, and states of each round but the last; or the centers, and
    // what the first round leaves.
    const int planes = params.tolerance > 0 ? 4 + f32::RT_EDGE_ROUNDS - 1 : 3 + 4;
    const FlatTile wide = size_with_margin(tile, tile_margin(params));
    return static_cast<std::size_t>(planes * (wide.width * wide.height + lanes));
}

/// A guess of a pixel's samples, for how much to do at a time.
inline constexpr int round_samples_guess = 8;

/// Renders a tile on this thread; false if stopped before the last pixel. `planes` is scratch
/// memory. Counts the rays, but not the samples at the pixels' centers.
template <typename T, typename IsStopped>
bool render_tile_in_rounds(const NativeKernels<T>& kernels, const NativeView<T>& view,
                           const typename Flat<T>::Tile& tile, std::vector<T>& planes, T* film,
                           typename Flat<T>::RayCounts& counts, const IsStopped& is_stopped) {
    using Index = typename Flat<T>::Index;
    const int margin = tile_margin(view.params);
    const auto wide = size_with_margin(tile, margin);
    const PacketShape shape = packet_shape(kernels.lanes, 1);
    const Index packets = (wide.width + shape.width - 1) / shape.width;
    planes.resize(plane_values(view.params, tile, kernels.lanes));
    for (Index row = 0; row * shape.height < wide.height; ++row) {
        if (is_stopped()) return false;
        kernels.render_centers(planes.data(), &counts, &view, &tile, row * packets,
                               (row + 1) * packets);
    }
    const int rounds = round_count(view.params);
    for (int round = 0; round < rounds; ++round) {
        const auto seen = size_with_margin(tile, rounds - 1 - round);
        const Index across = (seen.width + kernels.lanes - 1) / kernels.lanes;
        for (Index row = 0; row < seen.height; ++row) {
            if (is_stopped()) return false;
            kernels.render_round(film, &counts, &view, &tile, planes.data(), round, row * across,
                                 (row + 1) * across);
        }
    }
    return true;
}

}  // namespace rt
