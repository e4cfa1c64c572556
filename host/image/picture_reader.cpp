// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "host/base/error.h"
#include "host/image/input_file.h"
#include "host/image/module_loader.h"
#include "host/image/pfm_file.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"
#include "host/image/png_file.h"
#include "host/image/stored_size.h"

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

PictureFile read_with_module(const std::string& path, PictureFormat format, InputFile file) {
    if (format == PictureFormat::jpeg) check_jpeg_end(path, file);
    const PictureModule& library = picture_module(format, ExitCode::input);
    const auto check = [&](int width, int height, int channels) {
        check_picture_size(path, width, height, channels);
        check_stored_values(path, format, std::uintmax_t(width) * height * channels, file.size);
        check_picture_memory(path, width, height, channels);
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

}  // namespace

PictureFile read_picture_file(const std::string& path) try {
    InputFile file = open_input_file(path);
    const PictureFormat format = find_format(path, file);
    if (format == PictureFormat::png) return read_png(path, file.stream, file.size);
    if (format == PictureFormat::pfm) return {read_pfm(path, std::move(file)), {}};
    return read_with_module(path, format, std::move(file));
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::limit, path + ": not enough memory for its pixels; scale it down first");
}

Picture read_picture(const std::string& path) { return read_picture_file(path).picture; }

}  // namespace rt
