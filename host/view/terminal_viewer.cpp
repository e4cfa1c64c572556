// SPDX-License-Identifier: Apache-2.0
#include "host/view/terminal_viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/image/picture_io.h"
#include "host/view/terminal_pictures.h"

namespace rt {

namespace {

constexpr int kitty_id = 4212;
constexpr int lines_below = 2;  ///< left free for the shell's prompt

}  // namespace

PreviewMode preview_mode(const Terminal& terminal, PreviewMode asked) {
    if (asked != PreviewMode::automatic) return asked;
    if (terminal.shows_kitty) return PreviewMode::kitty;
    return terminal.shows_sixels ? PreviewMode::sixel : PreviewMode::half;
}

void TerminalViewer::begin(int width, int height) {
    const bool blocks = mode_ == PreviewMode::half;
    // Pixels per cell: two half blocks, or the terminal's real ones.
    const int cell_width = blocks ? 1 : terminal_.size.cell_width;
    const int cell_height = blocks ? 2 : terminal_.size.cell_height;
    const double room_x = double(terminal_.size.columns) * cell_width;
    const double room_y = double(std::max(terminal_.size.rows - lines_below, 1)) * cell_height;
    const double scale = std::min({1.0, room_x / width, room_y / height});
    width_ = std::max(static_cast<int>(std::floor(width * scale)), 1);
    height_ = std::max(static_cast<int>(std::floor(height * scale)), 1);
    columns_ = (width_ + cell_width - 1) / cell_width;
    rows_ = (height_ + cell_height - 1) / cell_height;
    is_drawn_ = false;
}

std::string TerminalViewer::drawn(const Picture& picture) const {
    const Picture small = shrink(picture, width_, height_);
    if (mode_ == PreviewMode::kitty) {
        return kitty_picture(encode_png(small, encoding_), kitty_id, columns_, rows_);
    }
    const std::vector<std::uint8_t> rgb = encode_8bit(small, encoding_);
    return mode_ == PreviewMode::sixel ? sixel_picture(rgb, width_)
                                       : half_blocks(rgb, width_, terminal_.true_color);
}

/// Graphics protocols differ in where they leave the cursor: so make room first, save and restore
/// the cursor, and then move it below the picture.
void TerminalViewer::draw(const Picture& picture) {
    std::string text;
    if (!is_drawn_ && mode_ != PreviewMode::half)
        text.append(static_cast<std::size_t>(rows_), '\n');
    if (is_drawn_ || mode_ != PreviewMode::half) text += fmt::format("\x1b[{}A\r", rows_);
    if (mode_ == PreviewMode::half) {
        text += drawn(picture);
    } else {
        text +=
            "\x1b"
            "7" +
            drawn(picture) +
            "\x1b"
            "8" +
            fmt::format("\x1b[{}B\r", rows_);
    }
    is_drawn_ = true;
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void TerminalViewer::update(const Picture& picture, std::span<const Rect>) { draw(picture); }

void TerminalViewer::finish(const Picture& picture) { draw(picture); }

}  // namespace rt
