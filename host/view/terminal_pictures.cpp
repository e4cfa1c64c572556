// SPDX-License-Identifier: Apache-2.0
#include "host/view/terminal_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "host/base/text.h"

namespace rt {

namespace {

constexpr int cube_side = 6;  ///< of xterm's colors 16 to 231, and of ours

/// Brightness levels of xterm's color cube.
constexpr std::array<int, cube_side> xterm_levels{0, 95, 135, 175, 215, 255};

int nearest_level(int value) {
    int best = 0;
    for (int i = 1; i < cube_side; ++i) {
        if (std::abs(xterm_levels[i] - value) < std::abs(xterm_levels[best] - value)) best = i;
    }
    return best;
}

/// "38;2;R;G;B" or "38;5;N"; 48 for what lies behind.
std::string color_code(int layer, const std::uint8_t* rgb, bool true_color) {
    if (true_color) return fmt::format("{};2;{};{};{}", layer, rgb[0], rgb[1], rgb[2]);
    const int cube = 36 * nearest_level(rgb[0]) + 6 * nearest_level(rgb[1]) + nearest_level(rgb[2]);
    return fmt::format("{};5;{}", layer, 16 + cube);
}

/// The cube level of a value, dithered with a 4 x 4 Bayer matrix.
int dithered_level(int value, std::size_t x, std::size_t y) {
    constexpr std::array<int, 16> bayer{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    const int threshold = 2 * bayer[4 * (y % 4) + x % 4] + 1;  // of 32
    return (value * (cube_side - 1) * 32 + 255 * threshold) / (255 * 32);
}

/// Run-length encodes characters as "!COUNT".
void add_run(std::string& text, std::size_t count, char sixel) {
    if (count > 3) {
        text += fmt::format("!{}{}", count, sixel);
    } else {
        text.append(count, sixel);
    }
}

}  // namespace

Picture shrink(const Picture& picture, int width, int height) {
    Picture small{width, height, 3, {}};
    small.pixels.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto edge = [](int i, int parts, int whole) {
        return static_cast<int>(std::int64_t{i} * whole / parts);
    };
    for (int y = 0; y < height; ++y) {
        const int top = edge(y, height, picture.height);
        const int bottom = std::max(edge(y + 1, height, picture.height), top + 1);
        for (int x = 0; x < width; ++x) {
            const int left = edge(x, width, picture.width);
            const int right = std::max(edge(x + 1, width, picture.width), left + 1);
            double sum[3]{};
            for (int row = top; row < bottom; ++row) {
                const float* at = picture.pixels.data() +
                                  3 * (static_cast<std::size_t>(row) * picture.width + left);
                for (int i = 0; i < 3 * (right - left); ++i) sum[i % 3] += at[i];
            }
            const double count = double(bottom - top) * (right - left);
            for (const double value : sum)
                small.pixels.push_back(static_cast<float>(value / count));
        }
    }
    return small;
}

std::string half_blocks(std::span<const std::uint8_t> rgb, int width, bool true_color) {
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    std::string text;
    for (std::size_t top = 0; top < rgb.size(); top += 2 * row) {
        const bool has_lower = top + row < rgb.size();
        std::string before;
        for (std::size_t x = 0; x < row; x += 3) {
            std::string code = color_code(38, &rgb[top + x], true_color);
            if (has_lower) code += ";" + color_code(48, &rgb[top + row + x], true_color);
            if (code != before) text += "\x1b[" + code + "m";
            text += "▀";
            before = std::move(code);
        }
        text += "\x1b[0m\n";
    }
    return text;
}

std::string kitty_picture(std::span<const std::byte> png, int id, int columns, int rows) {
    constexpr std::size_t longest = 4096;
    const std::string data = base64(png);
    std::string text;
    for (std::size_t at = 0; at < data.size(); at += longest) {
        const bool is_last = at + longest >= data.size();
        const std::string keys =
            at == 0 ? fmt::format("a=T,f=100,i={},p=1,q=2,C=1,c={},r={},", id, columns, rows) : "";
        text +=
            fmt::format("\x1b_G{}m={};{}\x1b\\", keys, is_last ? 0 : 1, data.substr(at, longest));
    }
    return text;
}

std::string sixel_picture(std::span<const std::uint8_t> rgb, int width) {
    constexpr int colors = cube_side * cube_side * cube_side;
    constexpr std::size_t band = 6;  // rows
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t height = rgb.size() / 3 / columns;
    std::string text = fmt::format("\x1bPq\"1;1;{};{}", width, height);
    for (int i = 0; i < colors; ++i) {
        text += fmt::format("#{};2;{};{};{}", i, i / 36 * 20, i / 6 % 6 * 20, i % 6 * 20);
    }
    std::vector<std::uint8_t> indices(band * columns);
    for (std::size_t top = 0; top < height; top += band) {
        const std::size_t rows = std::min(band, height - top);
        std::array<bool, colors> is_used{};
        for (std::size_t i = 0; i < rows * columns; ++i) {
            const std::size_t x = i % columns, y = top + i / columns;
            const std::uint8_t* const at = &rgb[3 * (y * columns + x)];
            const int index = 36 * dithered_level(at[0], x, y) + 6 * dithered_level(at[1], x, y) +
                              dithered_level(at[2], x, y);
            indices[i] = static_cast<std::uint8_t>(index);
            is_used[static_cast<std::size_t>(index)] = true;
        }
        for (std::size_t color = 0; color < colors; ++color) {
            if (!is_used[color]) continue;
            text += fmt::format("#{}", color);
            char before = 0;
            std::size_t run = 0;
            for (std::size_t x = 0; x < columns; ++x) {
                int bits = 0;
                for (std::size_t y = 0; y < rows; ++y) {
                    if (indices[y * columns + x] == color) bits |= 1 << y;
                }
                const auto sixel = static_cast<char>('?' + bits);
                if (sixel != before) {
                    add_run(text, run, before);
                    run = 0;
                }
                before = sixel;
                ++run;
            }
            add_run(text, run, before);
            text += '$';
        }
        text += '-';
    }
    return text + "\x1b\\";
}

}  // namespace rt
