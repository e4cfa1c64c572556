// SPDX-License-Identifier: Apache-2.0
#include "host/image/picture_format.h"

#include <algorithm>
#include <array>
#include <limits>

#include "host/base/lower.h"
#include "host/base/usage_error.h"

namespace rt {
namespace {

struct FormatNames {
    PictureFormat format;
    std::string_view name;
    const char* module_name;
    std::array<std::string_view, 3> extensions;
};

constexpr FormatNames formats[] = {
    {PictureFormat::png, "PNG", "png", {".png"}},
    {PictureFormat::exr, "EXR", "openexr", {".exr"}},
    {PictureFormat::pfm, "PFM", "pfm", {".pfm"}},
    {PictureFormat::tiff, "TIFF", "tiff", {".tif", ".tiff"}},
    {PictureFormat::jpeg, "JPEG", "jpeg", {".jpg", ".jpeg"}},
    {PictureFormat::webp, "WebP", "webp", {".webp"}},
    {PictureFormat::hdr, "HDR", "hdr", {".hdr"}},
    {PictureFormat::tga, "TGA", "targa", {".tga"}},
    {PictureFormat::bmp, "BMP", "bmp", {".bmp"}},
    {PictureFormat::pnm, "PNM", "pnm", {".ppm", ".pgm", ".pnm"}},
    {PictureFormat::dpx, "DPX", "dpx", {".dpx"}},
};

const FormatNames& names_of(PictureFormat format) {
    return *std::find_if(std::begin(formats), std::end(formats),
                         [format](const FormatNames& names) { return names.format == format; });
}

}  // namespace

std::string_view to_string(PictureFormat format) { return names_of(format).name; }

const char* module_name(PictureFormat format) { return names_of(format).module_name; }

bool stores_floats(PictureFormat format) {
    return format == PictureFormat::exr || format == PictureFormat::pfm ||
           format == PictureFormat::tiff || format == PictureFormat::hdr;
}

int longest_side(PictureFormat format) {
    switch (format) {
        case PictureFormat::jpeg:
            return 65500;  // libjpeg's; it ends the process beyond
        case PictureFormat::webp:
            return 16383;
        case PictureFormat::tga:
            return 65535;
        default:
            return std::numeric_limits<int>::max();
    }
}

bool needs_module(PictureFormat format) {
    return format != PictureFormat::png && format != PictureFormat::pfm;
}

std::optional<PictureFormat> known_picture_format(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (extension.empty()) return std::nullopt;
    for (const FormatNames& names : formats) {
        const auto& extensions = names.extensions;
        if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
            return names.format;
        }
    }
    return std::nullopt;
}

PictureFormat picture_format_of_name(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".pgm") {
        usage_error("{}: PGM has no color; use .ppm", path);
    }
    if (const auto format = known_picture_format(path)) return *format;
    usage_error("{}: {}; use .png, .exr, .pfm, .tif, .jpg, .webp, .hdr, .tga, .bmp, .ppm or .dpx",
                path,
                extension.empty() ? "no file extension" : "unknown extension '" + extension + "'");
}

std::optional<PictureFormat> picture_format_of_bytes(std::string_view first_bytes) {
    struct Signature {
        std::string_view bytes;
        PictureFormat format;
    };
    using namespace std::string_view_literals;
    static constexpr Signature signatures[] = {
        {"\x89PNG\r\n\x1a\n"sv, PictureFormat::png},
        {"\x76\x2f\x31\x01"sv, PictureFormat::exr},
        {"PF"sv, PictureFormat::pfm},
        {"Pf"sv, PictureFormat::pfm},
        {"\xff\xd8\xff"sv, PictureFormat::jpeg},
        {"II*\0"sv, PictureFormat::tiff},
        {"MM\0*"sv, PictureFormat::tiff},
        {"II+\0"sv, PictureFormat::tiff},
        {"MM\0+"sv, PictureFormat::tiff},
        {"#?RADIANCE"sv, PictureFormat::hdr},
        {"#?RGBE"sv, PictureFormat::hdr},
        {"BM"sv, PictureFormat::bmp},
        {"SDPX"sv, PictureFormat::dpx},
        {"XPDS"sv, PictureFormat::dpx},
    };
    for (const Signature& signature : signatures) {
        if (first_bytes.starts_with(signature.bytes)) return signature.format;
    }
    if (first_bytes.starts_with("RIFF") &&
        first_bytes.substr(std::min(8ul, first_bytes.size())).starts_with("WEBP")) {
        return PictureFormat::webp;
    }
    const bool is_pnm = first_bytes.size() > 1 && first_bytes[0] == 'P' && first_bytes[1] >= '1' &&
                        first_bytes[1] <= '6';
    if (is_pnm) return PictureFormat::pnm;
    return std::nullopt;
}

}  // namespace rt
