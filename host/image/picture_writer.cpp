// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <string_view>
#include <vector>

#include "host/base/error.h"
#include "host/image/atomic_file.h"
#include "host/image/built_in_formats.h"
#include "host/image/output_path.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"
#include "host/image/picture_module.h"

namespace rt {
namespace {

using Metadata = std::span<const std::pair<std::string, std::string>>;

void check_picture(const std::string& path, const Picture& picture) {
    const bool has_size =
        picture.width > 0 && picture.height > 0 && picture.channels >= 1 &&
        (picture.channel_names.empty()
             ? picture.channels <= 4
             : picture.channel_names.size() == static_cast<std::size_t>(picture.channels));
    if (has_size && picture.pixels.size() == static_cast<std::size_t>(picture.width) *
                                                 picture.height * picture.channels) {
        return;
    }
    throw Error(
        ExitCode::bug,
        fmt::format("{}: a picture of {} x {} x {} with {} values; please report this", path,
                    picture.width, picture.height, picture.channels, picture.pixels.size()));
}

void check_metadata(const std::string& path, Metadata metadata) {
    constexpr std::string_view prefix = "mirrorball:";
    constexpr std::size_t longest = 31;  // for EXR attribute names
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    for (const auto& [name, text] : metadata) {
        const std::string_view rest = std::string_view(name).substr(std::min(11ul, name.size()));
        if (name.starts_with(prefix) && !rest.empty() && name.size() <= longest &&
            std::all_of(rest.begin(), rest.end(), is_plain) &&
            text.find('\0') == std::string::npos) {
            continue;
        }
        throw Error(ExitCode::bug,
                    path + ": metadata '" + name + "' cannot be stored; please report this");
    }
}

std::vector<std::byte> encode_with_module(const std::string& path, PictureFormat format,
                                          const Picture& picture, Encoding encoding,
                                          Metadata metadata) {
    EncodeRequest request{module_name(format), picture, {}, nullptr, metadata};
    std::vector<std::uint8_t> bytes;
    if (!stores_floats(format)) {
        bytes = encode_8bit(picture, encoding);
        request.bytes = bytes;
        request.color_space = encoding == Encoding::srgb     ? "sRGB"
                              : encoding == Encoding::linear ? "Linear"
                                                             : nullptr;
    }
    const PictureModule& library = picture_module(format, ExitCode::output);
    try {
        return library.encode(request);
    } catch (const std::exception& error) {
        const bool is_full = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        fail_to_encode(path, is_full ? "out of memory" : error.what());
    }
}

}  // namespace

void write_picture(const std::string& path, const Picture& picture, Encoding encoding,
                   Metadata metadata, std::optional<PictureFormat> format) {
    if (!format) format = picture_format_of_name(path);
    check_picture_path(path, format);
    check_picture_fits(path, picture.width, picture.height, format);
    check_picture(path, picture);
    check_metadata(path, metadata);
    if (format == PictureFormat::pfm) return write_pfm(path, picture);
    write_file_atomically(path,
                          format == PictureFormat::png
                              ? encode_png_file(path, picture, encoding, metadata)
                              : encode_with_module(path, *format, picture, encoding, metadata));
}

std::vector<std::byte> encode_png(const Picture& picture, Encoding encoding) {
    const std::string what = "a picture in memory";
    check_picture(what, picture);
    return encode_png_file(what, picture, encoding, {});
}

void check_picture_fits(const std::string& path, int width, int height,
                        std::optional<PictureFormat> format) {
    if (!format) format = picture_format_of_name(path);
    const int most = longest_side(*format);
    if (width <= most && height <= most) return;
    throw Error(
        ExitCode::limit,
        fmt::format("{}: {}x{} pixels are too many for {}, which has at most {} per side; use "
                    ".png or .exr, or reduce --size",
                    path, width, height, to_string(*format), most));
}

void check_picture_path(const std::string& path, std::optional<PictureFormat> format) {
    if (!format) format = picture_format_of_name(path);
    check_output_path(path);
    if (needs_module(*format)) picture_module(*format, ExitCode::output);
}

}  // namespace rt
