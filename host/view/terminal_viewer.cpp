// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "host/view/viewer.h"

namespace rt {

namespace {

constexpr int lines_below = 2;  ///< left free for the shell's prompt

/// Whether the locale's encoding is UTF-8.
bool is_utf8() {
    const locale_t locale = newlocale(LC_CTYPE_MASK, "", nullptr);
    if (locale == nullptr) return false;
    const bool result = std::string_view(nl_langinfo_l(CODESET, locale)) == "UTF-8";
    freelocale(locale);
    return result;
}

/// "38;2;R;G;B"; 48 for what lies behind.
std::string color_code(int layer, const std::uint8_t* rgb) {
    return fmt::format("{};2;{};{};{}", layer, rgb[0], rgb[1], rgb[2]);
}

/// Downsamples, each pixel the mean of those that it covers; 1 x 1 at least.
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

/// Rows that end in "\n". Under an odd last row is the terminal's background.
std::string half_blocks(std::span<const std::uint8_t> rgb, int width) {
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    std::string text;
    for (std::size_t top = 0; top < rgb.size(); top += 2 * row) {
        const bool has_lower = top + row < rgb.size();
        std::string before;
        for (std::size_t x = 0; x < row; x += 3) {
            std::string code = color_code(38, &rgb[top + x]);
            if (has_lower) code += ";" + color_code(48, &rgb[top + row + x]);
            if (code != before) text += "\x1b[" + code + "m";
            text += "▀";
            before = std::move(code);
        }
        text += "\x1b[0m\n";
    }
    return text;
}

/// Draws the picture in stderr's terminal in upper half blocks, two pixels each, scaled down to
/// fit but never up, redrawing it in the same place.
class TerminalViewer : public Viewer {
   public:
    explicit TerminalViewer(Encoding encoding) : encoding_(encoding) {}

    void begin(int width, int height) override {
        const TerminalSize size = terminal_size();
        const double room = 2.0 * std::max(size.rows - lines_below, 1);
        const double scale = std::min({1.0, double(size.columns) / width, room / height});
        width_ = std::max(static_cast<int>(std::floor(width * scale)), 1);
        height_ = std::max(static_cast<int>(std::floor(height * scale)), 1);
        is_drawn_ = false;
    }
    void update(const Picture& picture, std::span<const Rect>) override { draw(picture); }
    void finish(const Picture& picture) override { draw(picture); }

   private:
    void draw(const Picture& picture) {
        std::string text;
        if (std::exchange(is_drawn_, true)) text = fmt::format("\x1b[{}A\r", (height_ + 1) / 2);
        text += half_blocks(encode_8bit(shrink(picture, width_, height_), encoding_), width_);
        std::fwrite(text.data(), 1, text.size(), stderr);
        std::fflush(stderr);
    }

    const Encoding encoding_;
    int width_ = 0, height_ = 0;  ///< pixels that are drawn
    bool is_drawn_ = false;
};

}  // namespace

TerminalSize terminal_size() {
    TerminalSize result;
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0) return result;
    if (size.ws_col > 0) result.columns = size.ws_col;
    if (size.ws_row > 0) result.rows = size.ws_row;
    return result;
}

std::unique_ptr<Viewer> make_preview(const ViewSettings& settings, Encoding encoding,
                                     const Say& say) {
    const bool has_colors =
        !settings.terminal.empty() && settings.terminal != "dumb" && !settings.without_colors;
    if (isatty(STDERR_FILENO) != 1) {
        say("no preview: standard error is not a terminal");
    } else if (!has_colors || !is_utf8()) {
        say("no preview: the terminal does not support colors or UTF-8");
    } else {
        return std::make_unique<TerminalViewer>(encoding);
    }
    return nullptr;
}

}  // namespace rt
