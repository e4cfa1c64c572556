// SPDX-License-Identifier: Apache-2.0
#include "host/image/picture_format.h"

#include <algorithm>

#include "host/base/error.h"
#include "host/base/text.h"

namespace rt {
namespace {

constexpr PictureFormatFacts formats[] = {
    {PictureFormat::png, "PNG", "png", {".png"}},
    {PictureFormat::exr, "EXR", "openexr", {".exr"}, true},
    {PictureFormat::pfm, "PFM", "pfm", {".pfm"}, true},
    {PictureFormat::tiff, "TIFF", "tiff", {".tif", ".tiff"}, true},
    // libjpeg ends the process beyond its longest side.
    {PictureFormat::jpeg, "JPEG", "jpeg", {".jpg", ".jpeg"}, false, 65500},
    {PictureFormat::webp, "WebP", "webp", {".webp"}, false, 16383},
    {PictureFormat::hdr, "HDR", "hdr", {".hdr"}, true},
    {PictureFormat::tga, "TGA", "targa", {".tga"}, false, 65535},
    {PictureFormat::bmp, "BMP", "bmp", {".bmp"}},
    {PictureFormat::pnm, "PNM", "pnm", {".ppm", ".pgm", ".pnm"}},
    {PictureFormat::dpx, "DPX", "dpx", {".dpx"}},
};

}  // namespace

const PictureFormatFacts& facts_of(PictureFormat format) {
    return *std::ranges::find(formats, format, &PictureFormatFacts::format);
}

std::optional<PictureFormat> known_picture_format(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (extension.empty()) return std::nullopt;
    for (const PictureFormatFacts& one : formats) {
        if (std::ranges::count(one.extensions, extension) > 0) return one.format;
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
                extension.empty() ? "no file extension (for standard output, name -)"
                                  : "unknown extension '" + extension + "'");
}

}  // namespace rt
