// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/image/picture.h"

// Encodes pictures for display in a terminal. `rgb`: 8 bits a channel, row 0 at the top.
namespace rt {

/// Downsamples, each pixel the mean of those that it covers; 1 x 1 at least.
Picture shrink(const Picture& picture, int width, int height);

/// Upper half blocks, two pixels each, the upper one in the foreground color: rows that end in
/// "\n". Under an odd last row is the terminal's background. `true_color`: 24 bits, else the
/// nearest of xterm's 256.
std::string half_blocks(std::span<const std::uint8_t> rgb, int width, bool true_color);

/// A PNG file in kitty's graphics protocol, scaled to `columns` x `rows` cells; the cursor stays. A
/// picture replaces the previous one with the same `id`.
std::string kitty_picture(std::span<const std::byte> png, int id, int columns, int rows);

/// DEC's sixels in a cube of 6 x 6 x 6 colors, with ordered dithering.
std::string sixel_picture(std::span<const std::uint8_t> rgb, int width);

}  // namespace rt
