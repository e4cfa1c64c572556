// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "host/base/error.h"
#include "host/base/number.h"
#include "host/image/atomic_file.h"
#include "host/image/built_in_formats.h"

namespace rt {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are written as they are");

struct Header {
    int channels = 0;
    int width = 0;
    int height = 0;
    double scale = 0;
};

/// The next word of the header with the one white space behind it; empty when there is none.
std::string next_word(std::istream& stream) {
    constexpr std::size_t longest = 32;
    std::string word;
    for (int c = stream.get(); c != EOF && word.size() <= longest; c = stream.get()) {
        const bool is_space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (is_space) return word;
        word += static_cast<char>(c);
    }
    return {};
}

Header read_header(const std::string& path, std::istream& stream) {
    const std::string kind = next_word(stream);
    const auto width = parse_number<int>(next_word(stream));
    const auto height = parse_number<int>(next_word(stream));
    const auto scale = parse_number<double>(next_word(stream));
    if ((kind != "PF" && kind != "Pf") || !width || !height || !scale || *scale == 0 ||
        !std::isfinite(*scale)) {
        refuse_picture(
            path, "damaged PFM header: expected PF or Pf, width, height and a scale other than 0",
            "save it again");
    }
    return {kind == "PF" ? 3 : 1, *width, *height, *scale};
}

}  // namespace

void write_pfm(const std::string& path, const Picture& picture) {
    if (picture.channels != 1 && picture.channels != 3) {
        throw Error(ExitCode::output,
                    fmt::format("{}: PFM stores 1 or 3 channels, not {}; use .exr", path,
                                picture.channels));
    }
    const std::string header = fmt::format("{}\n{} {}\n-1.0\n", picture.channels == 3 ? "PF" : "Pf",
                                           picture.width, picture.height);
    const auto row = static_cast<std::size_t>(picture.width) * picture.channels;
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(header)));
    for (int y = picture.height - 1; y >= 0; --y) {
        file.write(std::as_bytes(std::span(picture.pixels).subspan(row * y, row)));
    }
    file.commit();
}

Picture read_pfm(const std::string& path, InputFile file, bool with_pixels) {
    const Header header = read_header(path, file.stream);
    check_picture_size(path, header.width, header.height, header.channels);

    Picture picture{header.width, header.height, header.channels, {}};
    const auto row = static_cast<std::size_t>(header.width) * header.channels;
    const std::uintmax_t expected = row * header.height * sizeof(float);
    const auto start = static_cast<std::uintmax_t>(file.stream.tellg());
    if (file.size - start != expected) {
        refuse_picture(path,
                       fmt::format("has {} bytes of pixels, but its header declares {}",
                                   file.size - start, expected),
                       "save it again");
    }
    if (!with_pixels) return picture;
    check_picture_memory(path, header.width, header.height, header.channels);
    picture.pixels.resize(row * header.height);
    for (int y = header.height - 1; y >= 0; --y) {
        auto* target = reinterpret_cast<char*>(picture.pixels.data() + row * y);
        file.stream.read(target, static_cast<std::streamsize>(row * sizeof(float)));
    }
    if (!file.stream) refuse_picture(path, "cannot read", "check the disk");
    if (header.scale < 0) return picture;
    for (float& value : picture.pixels) {
        value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
    }
    return picture;
}

}  // namespace rt
