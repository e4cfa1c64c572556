// SPDX-License-Identifier: Apache-2.0
#include "host/image/false_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace rt {

namespace {

using Color = std::array<float, 3>;

constexpr int legend_height = 20;
constexpr int least_width = 200;  ///< for the legend's three numbers and a scale
constexpr int letter_scale = 2;   ///< pixels per font dot
constexpr int letter_width = 4 * letter_scale;

/// Samples of matplotlib's viridis at equal distances.
constexpr std::array<Color, 5> viridis{{{0.267f, 0.005f, 0.329f},
                                        {0.230f, 0.322f, 0.546f},
                                        {0.128f, 0.567f, 0.551f},
                                        {0.369f, 0.789f, 0.383f},
                                        {0.993f, 0.906f, 0.144f}}};

Color viridis_at(float share) {
    const float place = std::clamp(share, 0.0f, 1.0f) * (viridis.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
    Color color;
    for (std::size_t k = 0; k < 3; ++k) {
        color[k] =
            std::lerp(viridis[below][k], viridis[below + 1][k], place - static_cast<float>(below));
    }
    return color;
}

Color normal_color(float x, float y, float z) {
    return {0.5f * x + 0.5f, 0.5f * y + 0.5f, 0.5f * z + 0.5f};
}

/// A 3-dot-wide bitmap of a character used in numbers, top row first.
std::uint16_t dots_of(char letter) {
    static constexpr std::string_view letters = "0123456789.-+e";
    static constexpr std::array<std::uint16_t, letters.size()> dots{
        0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
        0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'010'010'010,
        0b111'101'111'101'111, 0b111'101'111'001'111, 0b000'000'000'000'010, 0b000'000'111'000'000,
        0b000'010'111'010'000, 0b000'111'111'100'111};
    const std::size_t at = letters.find(letter);
    return at == letters.npos ? std::uint16_t{0} : dots[at];
}

class Canvas {
   public:
    /// A black canvas, with room for a legend below if needed.
    Canvas(int width, int height, bool has_legend) : top_(height) {
        picture_.width = has_legend ? std::max(width, least_width) : width;
        picture_.height = height + (has_legend ? legend_height : 0);
        picture_.pixels.resize(static_cast<std::size_t>(picture_.width) * picture_.height * 3);
    }

    int width() const { return picture_.width; }
    int legend_top() const { return top_; }

    void set(int x, int y, const Color& color) {
        const auto at = static_cast<std::size_t>(y) * picture_.width + static_cast<std::size_t>(x);
        std::copy(color.begin(), color.end(),
                  picture_.pixels.begin() + static_cast<std::ptrdiff_t>(3 * at));
    }

    /// Writes white text in the legend, starting at x.
    void write(int x, std::string_view text) {
        constexpr int across = 3, down = 5;
        for (const char letter : text) {
            const std::uint16_t dots = dots_of(letter);
            for (int i = 0; i < across * letter_scale * down * letter_scale; ++i) {
                const int dx = i % (across * letter_scale), dy = i / (across * letter_scale);
                const int dot = dy / letter_scale * across + dx / letter_scale;
                if ((dots >> (across * down - 1 - dot) & 1) == 0) continue;
                set(x + dx, top_ + (legend_height - down * letter_scale) / 2 + dy, {1, 1, 1});
            }
            x += letter_width;
        }
    }

    Picture take() { return std::move(picture_); }

   private:
    const int top_;
    Picture picture_;
};

/// Colors each pixel that has a value.
template <typename ColorOf>
Canvas colored(int width, int height, bool has_legend, const ColorOf& color_of) {
    Canvas canvas(width, height, has_legend);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::optional<Color> color =
                color_of(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
            if (color) canvas.set(x, y, *color);
        }
    }
    return canvas;
}

/// The color map's range: both ends and the midpoint.
class Range {
   public:
    Range(std::span<const float> values, Scale scale) : is_log_(scale == Scale::logarithmic) {
        for (const float value : values) {
            if (value == 0) continue;
            least_ = std::min(least_, value);
            most_ = std::max(most_, value);
        }
    }

    bool is_empty() const { return most_ < least_; }

    Color color(float value) const {
        if (most_ <= least_) return viridis_at(0);
        return viridis_at(is_log_ ? std::log(value / least_) / std::log(most_ / least_)
                                  : (value - least_) / (most_ - least_));
    }

    void add_legend(Canvas& canvas) const {
        const std::string left = text(least_), right = text(most_);
        const std::string middle =
            text(is_log_ ? std::sqrt(least_) * std::sqrt(most_) : 0.5f * (least_ + most_));
        const int first = 2 * gap + length(left);
        const int end = canvas.width() - length(right) - gap;
        const int middle_first = (first + end - length(middle)) / 2;
        canvas.write(gap, left);
        canvas.write(middle_first, middle);
        canvas.write(end + gap, right);
        for (int x = first; x < end; ++x) {
            if (x >= middle_first - gap && x < middle_first + length(middle)) continue;
            const Color color = viridis_at(static_cast<float>(x - first) /
                                           static_cast<float>(std::max(end - 1 - first, 1)));
            for (int y = gap; y < legend_height - gap; ++y) {
                canvas.set(x, canvas.legend_top() + y, color);
            }
        }
    }

   private:
    static constexpr int gap = 4;

    static std::string text(float value) { return fmt::format("{:.4g}", value); }

    static int length(const std::string& text) {
        return letter_width * static_cast<int>(text.size());
    }

    const bool is_log_;
    float least_ = INFINITY, most_ = 0;
};

void add_ball(Canvas& canvas) {
    constexpr float radius = 0.5f * legend_height - 1;
    for (int row = 0; row < legend_height; ++row) {
        for (int column = 0; column < legend_height; ++column) {
            const float x = (static_cast<float>(column) + 0.5f - 0.5f * legend_height) / radius;
            const float y = (0.5f * legend_height - static_cast<float>(row) - 0.5f) / radius;
            const float rest = 1 - x * x - y * y;
            if (rest < 0) continue;
            canvas.set(column, canvas.legend_top() + row, normal_color(x, y, std::sqrt(rest)));
        }
    }
}

}  // namespace

Picture color_numbers(std::span<const float> values, int width, int height, Scale scale) {
    const Range range(values, scale);
    Canvas canvas = colored(width, height, true, [&](std::size_t i) -> std::optional<Color> {
        if (values[i] == 0) return {};
        return range.color(values[i]);
    });
    if (!range.is_empty()) range.add_legend(canvas);
    return canvas.take();
}

Picture color_normals(std::span<const float> normals, int width, int height) {
    Canvas canvas = colored(width, height, true, [&](std::size_t i) -> std::optional<Color> {
        const auto normal = normals.subspan(3 * i, 3);
        if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) return {};
        return normal_color(normal[0], normal[1], normal[2]);
    });
    add_ball(canvas);
    return canvas.take();
}

Picture color_ids(std::span<const std::int32_t> ids, int width, int height) {
    return colored(width, height, false,
                   [&](std::size_t i) -> std::optional<Color> {
                       if (ids[i] == 0) return {};
                       // Neighbors get colors far apart: multiples of an odd number near 2^32 /
                       // golden ratio.
                       const std::uint32_t mixed = static_cast<std::uint32_t>(ids[i]) * 0x9e3779b1u;
                       const auto part = [&](int shift) {
                           return 0.25f + 0.75f * static_cast<float>(mixed >> shift & 255u) / 255;
                       };
                       return Color{part(24), part(14), part(4)};
                   })
        .take();
}

}  // namespace rt
