// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/oiio_loader.h"
#include "host/image/output_path.h"
#include "host/image/pfm_file.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"

namespace rt {
namespace {

using Metadata = std::span<const std::pair<std::string, std::string>>;

void check_picture(const std::string& path, const Picture& picture) {
    const bool has_size =
        picture.width > 0 && picture.height > 0 && picture.channels >= 1 && picture.channels <= 4;
    if (has_size && picture.pixels.size() == static_cast<std::size_t>(picture.width) *
                                                 picture.height * picture.channels) {
        return;
    }
    throw Error(ExitCode::bug, path + ": a picture of " + std::to_string(picture.width) + " x " +
                                   std::to_string(picture.height) + " x " +
                                   std::to_string(picture.channels) + " with " +
                                   std::to_string(picture.pixels.size()) +
                                   " values; please report this");
}

void check_metadata(const std::string& path, Metadata metadata) {
    constexpr std::string_view prefix = "mirrorball:";
    constexpr std::size_t longest = 31;  // of an EXR attribute
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

/// Never throws: called from inside the module.
int append_bytes(void* context, const unsigned char* bytes, std::size_t count) {
    try {
        auto& target = *static_cast<std::vector<std::byte>*>(context);
        const auto* first = reinterpret_cast<const std::byte*>(bytes);
        target.insert(target.end(), first, first + count);
        return 1;
    } catch (...) {
        return 0;
    }
}

std::vector<std::byte> encode(const std::string& path, oiio::EncodeRequest request,
                              Metadata metadata) {
    std::vector<const char*> names;
    std::vector<const char*> texts;
    for (const auto& [name, text] : metadata) {
        if (text.empty()) continue;
        names.push_back(name.c_str());
        texts.push_back(text.c_str());
    }
    request.attribute_count = names.size();
    request.attribute_names = names.data();
    request.attribute_texts = texts.data();
    std::vector<std::byte> bytes;
    const oiio::ByteSink sink{&bytes, append_bytes};
    char error[1024] = "";
    const oiio::Module& library = image_library(ExitCode::output);
    if (library.encode(&request, &sink, {error, sizeof error}) == 0) {
        const std::string reason = error[0] == '\0' ? "out of memory" : error;
        throw Error(ExitCode::output, path + ": cannot encode the picture: " + reason +
                                          "; try .pfm, which needs no library");
    }
    return bytes;
}

std::vector<std::byte> encode_png_file(const std::string& path, const Picture& picture,
                                       Encoding encoding, Metadata metadata) {
    const std::vector<std::uint8_t> pixels = encode_8bit(picture, encoding);
    const char* color_space = encoding == Encoding::srgb     ? "sRGB"
                              : encoding == Encoding::linear ? "Linear"
                                                             : nullptr;
    return encode(path,
                  {"png", picture.width, picture.height, picture.channels, pixels.data(),
                   color_space, 0, nullptr, nullptr},
                  metadata);
}

std::vector<std::byte> encode_exr(const std::string& path, const Picture& picture,
                                  Metadata metadata) {
    return encode(path,
                  {"openexr", picture.width, picture.height, picture.channels,
                   picture.pixels.data(), nullptr, 0, nullptr, nullptr},
                  metadata);
}

std::vector<std::byte> encode_file(const std::string& path, const Picture& picture,
                                   Encoding encoding, Metadata metadata) {
    switch (picture_format_of_name(path)) {
        case PictureFormat::png:
            return encode_png_file(path, picture, encoding, metadata);
        case PictureFormat::exr:
            return encode_exr(path, picture, metadata);
        case PictureFormat::pfm:
            return encode_pfm(path, picture);
    }
    throw Error(ExitCode::bug, path + ": unknown picture format; please report this");
}

}  // namespace

void write_picture(const std::string& path, const Picture& picture, Encoding encoding,
                   Metadata metadata) {
    check_picture_path(path);
    check_picture(path, picture);
    check_metadata(path, metadata);
    write_file_atomically(path, encode_file(path, picture, encoding, metadata));
}

std::vector<std::byte> encode_png(const Picture& picture, Encoding encoding) {
    const std::string what = "a picture in memory";
    check_picture(what, picture);
    return encode_png_file(what, picture, encoding, {});
}

void check_picture_path(const std::string& path) {
    picture_format_of_name(path);
    check_output_path(path);
}

}  // namespace rt
