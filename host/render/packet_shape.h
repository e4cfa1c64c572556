// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "host/flatten/flat_types.h"

namespace rt {

/// How a packet's lanes are divided among pixels and samples, as in make_packet of
/// kernels/packet.cl.
struct PacketShape {
    int samples = 1;            ///< of each pixel
    int width = 1, height = 1;  ///< of the block of pixels

    int pixels() const { return width * height; }
};

/// A packet holds at most `most_samples` of each pixel.
inline PacketShape packet_shape(int lanes, int samples_of_a_pixel,
                                int most_samples = f32::RT_SAMPLES_TOGETHER) {
    PacketShape shape;
    while (2 * shape.samples <= std::min(lanes, most_samples) &&
           samples_of_a_pixel % (2 * shape.samples) == 0) {
        shape.samples *= 2;
    }
    for (int pixels = lanes / shape.samples; pixels > 1; pixels /= 2) {
        (shape.width > shape.height ? shape.height : shape.width) *= 2;
    }
    return shape;
}

}  // namespace rt
