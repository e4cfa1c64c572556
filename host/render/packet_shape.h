// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace rt {

/// How the lanes of a packet share out pixels and samples; as make_packet of kernels/packet.cl.
struct PacketShape {
    int samples = 1;            ///< of each pixel
    int width = 1, height = 1;  ///< of the block of pixels

    int pixels() const { return width * height; }
};

inline PacketShape packet_shape(int lanes, int samples_of_a_pixel) {
    PacketShape shape;
    shape.samples = std::min(lanes, samples_of_a_pixel % 4 == 0   ? 4
                                    : samples_of_a_pixel % 2 == 0 ? 2
                                                                  : 1);
    for (int pixels = lanes / shape.samples; pixels > 1; pixels /= 2) {
        (shape.width > shape.height ? shape.height : shape.width) *= 2;
    }
    return shape;
}

}  // namespace rt
