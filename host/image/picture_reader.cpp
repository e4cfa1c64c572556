// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "host/base/error.h"
#include "host/image/built_in_formats.h"
#include "host/image/input_file.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"
#include "host/image/picture_module.h"

namespace rt {
namespace {

/// The format by first bytes, unless the extension contradicts it; TGA has no magic number.
PictureFormat find_format(const std::string& path, InputFile& file) {
    char first_bytes[16] = {};
    file.stream.read(first_bytes, sizeof first_bytes);
    const auto count = static_cast<std::size_t>(file.stream.gcount());
    file.stream.clear();
    file.stream.seekg(0);
    if (count == 0) refuse_picture(path, "is empty", "save it again");
    const auto named = known_picture_format(path);
    const auto held = picture_format_of_bytes({first_bytes, count});
    if (held && (!named || named == held)) return *held;
    if (held) {
        refuse_picture(path, fmt::format("contains {} data", to_string(*held)),
                       "correct its extension");
    }
    if (named == PictureFormat::tga) return *named;
    if (named)
        refuse_picture(path, fmt::format("is not a valid {} file", to_string(*named)),
                       "save it again");
    refuse_picture(path, "is not in a supported format",
                   "use a PNG, EXR, PFM, TIFF, JPEG, WebP, HDR, TGA, BMP, PNM or DPX file");
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

/// What OpenImageIO's readers do not check: a file too small for the values that its header
/// promises, where the format limits its compression (WebP does not).
void check_stored_values(const std::string& path, PictureFormat format, std::uintmax_t values,
                         std::uintmax_t file_size) {
    const std::uintmax_t most = values_per_byte(format);
    if (most != 0) check_stored_size(path, values, most, file_size);
}

/// And a JPEG file that was cut short, whose missing pixels its reader makes up.
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
        check_stored_values(path, format, std::uintmax_t(width) * height * channels, file.size);
        if (with_pixels) check_picture_memory(path, width, height, channels);
        return with_pixels;
    };
    try {
        return library.decode(path, module_name(format), check);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse_damaged(path, one_line(error.what()));
    }
}

PictureFile read(const std::string& path, bool with_pixels) try {
    InputFile file = open_input_file(path);
    const PictureFormat format = find_format(path, file);
    if (format == PictureFormat::png) return read_png(path, file.stream, file.size, with_pixels);
    if (format == PictureFormat::pfm) return {read_pfm(path, std::move(file), with_pixels), {}};
    return read_with_module(path, format, std::move(file), with_pixels);
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::limit, path + ": not enough memory for its pixels; scale it down first");
}

}  // namespace

PictureFile read_picture_file(const std::string& path) { return read(path, true); }
PictureFile read_picture_header(const std::string& path) { return read(path, false); }
Picture read_picture(const std::string& path) { return read_picture_file(path).picture; }

}  // namespace rt
