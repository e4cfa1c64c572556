// SPDX-License-Identifier: Apache-2.0
#include "host/image/picture_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <new>

#include "host/base/error.h"
#include "host/base/files.h"
#include "host/base/text.h"
#include "host/image/built_in_formats.h"
#include "host/image/output_file.h"
#include "host/image/picture_module.h"

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

namespace {

const PictureModule& load(const char* name, const char* advice, ExitCode failure) {
    return *static_cast<const PictureModule*>(
        load_module({name, PictureModule::current_version, "the image library", advice}, failure));
}

/// OpenImageIO pulls in OpenBLAS, which would start a thread per core on loading.
const PictureModule& load_openimageio(ExitCode failure) {
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
    return load("libmirrorball_oiio.so",
                "reinstall libopenimageio2.4 and mirrorball, or use .png, .exr or .pfm", failure);
}

}  // namespace

const PictureModule& picture_module(PictureFormat format, ExitCode failure) {
    if (format == PictureFormat::exr) {
        static const PictureModule& exr =
            load("libmirrorball_exr.so",
                 "reinstall libopenexr-3-1-30 and mirrorball, or use .png or .pfm", failure);
        return exr;
    }
    static const PictureModule& others = load_openimageio(failure);
    return others;
}

namespace {

/// A JPEG file that was cut short has missing pixels, which OpenImageIO's reader makes up.
void check_jpeg_end(const std::string& path, InputFile& file) {
    const std::string bytes{std::istreambuf_iterator<char>(file.stream), {}};
    const std::size_t scan = bytes.rfind("\xff\xda");  // the last one; thumbnails come before
    if (scan != bytes.npos && bytes.find("\xff\xd9", scan) != bytes.npos) return;
    refuse_picture(path, "has no end-of-image marker", "it may be truncated: save it again");
}

PictureFile read_with_module(const std::string& path, PictureFormat format, InputFile file,
                             bool with_pixels) {
    if (format == PictureFormat::jpeg && with_pixels) check_jpeg_end(path, file);
    const PictureModule& library = picture_module(format, ExitCode::input);
    const auto check = [&](int width, int height, int channels) {
        check_picture_size(path, width, height, channels);
        if (with_pixels) check_picture_memory(path, width, height, channels);
        return with_pixels;
    };
    try {
        return library.decode(path, facts_of(format).module_name, check);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse_damaged(path, first_line(error.what()));
    }
}

PictureFile read(const std::string& path, bool with_pixels) try {
    InputFile file = open_input_file(path);
    const auto format = known_picture_format(path);
    if (!format) {
        refuse_picture(path, "has no extension of a picture format",
                       "use a .png, .exr, .pfm, .tif, .jpg, .webp, .hdr, .tga, .bmp, .ppm or .dpx");
    }
    if (file.size == 0) refuse_picture(path, "is empty", "save it again");
    if (format == PictureFormat::png) return read_png(path, file.stream, with_pixels);
    if (format == PictureFormat::pfm) return {read_pfm(path, std::move(file), with_pixels), {}};
    return read_with_module(path, *format, std::move(file), with_pixels);
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::limit, path + ": not enough memory for its pixels; scale it down first");
}

}  // namespace

PictureFile read_picture_file(const std::string& path) { return read(path, true); }
PictureFile read_picture_header(const std::string& path) { return read(path, false); }
Picture read_picture(const std::string& path) { return read_picture_file(path).picture; }

namespace {

using Metadata = std::span<const std::pair<std::string, std::string>>;

std::vector<std::byte> encode_with_module(const std::string& path, PictureFormat format,
                                          const Picture& picture, Encoding encoding,
                                          Metadata metadata) {
    EncodeRequest request{facts_of(format).module_name, picture, {}, nullptr, metadata};
    std::vector<std::uint8_t> bytes;
    if (!facts_of(format).stores_floats) {
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
    if (format == PictureFormat::pfm) return write_pfm(path, picture);
    write_file_atomically(path,
                          format == PictureFormat::png
                              ? encode_png_file(path, picture, encoding, metadata)
                              : encode_with_module(path, *format, picture, encoding, metadata));
}

void check_picture_fits(const std::string& path, int width, int height,
                        std::optional<PictureFormat> format) {
    if (!format) format = picture_format_of_name(path);
    const int most = facts_of(*format).longest_side;
    if (width <= most && height <= most) return;
    throw Error(
        ExitCode::limit,
        fmt::format("{}: {}x{} pixels are too many for {}, which has at most {} per side; use "
                    ".png or .exr, or reduce --size",
                    path, width, height, facts_of(*format).name, most));
}

void check_picture_path(const std::string& path, std::optional<PictureFormat> format) {
    if (!format) format = picture_format_of_name(path);
    check_output_path(path);
    const bool is_built_in = format == PictureFormat::png || format == PictureFormat::pfm;
    if (!is_built_in) picture_module(*format, ExitCode::output);
}

}  // namespace rt
