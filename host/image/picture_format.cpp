// SPDX-License-Identifier: Apache-2.0
#include "host/image/picture_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "host/error.h"

namespace rt {

PictureFormat picture_format_of_name(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return PictureFormat::png;
    if (extension == ".exr") return PictureFormat::exr;
    if (extension == ".pfm") return PictureFormat::pfm;
    const std::string what =
        extension.empty() ? "no extension" : "unknown extension '" + extension + "'";
    throw Error(ExitCode::usage, path + ": " + what + "; name the picture .png, .exr or .pfm");
}

bool needs_image_library(PictureFormat format) { return format != PictureFormat::pfm; }

std::string_view picture_format_of_bytes(std::string_view first_bytes) {
    struct Signature {
        std::string_view bytes;
        std::string_view format;
    };
    using namespace std::string_view_literals;
    static constexpr Signature signatures[] = {
        {"\x89PNG\r\n\x1a\n"sv, "png"},
        {"\x76\x2f\x31\x01"sv, "openexr"},
        {"PF"sv, "pfm"},
        {"Pf"sv, "pfm"},
        {"\xff\xd8\xff"sv, "jpeg"},
        {"II*\0"sv, "tiff"},
        {"MM\0*"sv, "tiff"},
        {"#?RADIANCE"sv, "hdr"},
        {"#?RGBE"sv, "hdr"},
        {"P1"sv, "pnm"},
        {"P2"sv, "pnm"},
        {"P3"sv, "pnm"},
        {"P4"sv, "pnm"},
        {"P5"sv, "pnm"},
        {"P6"sv, "pnm"},
    };
    for (const Signature& signature : signatures) {
        if (first_bytes.substr(0, signature.bytes.size()) == signature.bytes) {
            return signature.format;
        }
    }
    return {};
}

}  // namespace rt
