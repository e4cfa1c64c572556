// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "host/error.h"
#include "host/image/input_file.h"
#include "host/image/module_loader.h"
#include "host/image/pfm_file.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"
#include "host/image/png_file.h"
#include "host/image/stored_size.h"

namespace rt {
namespace {

/// What the module fills, and what went wrong on our side of the border.
struct Target {
    const std::string& path;
    PictureFormat format;
    std::uintmax_t size;  ///< of the file, in bytes
    PictureFile file = {};
    std::exception_ptr failure = nullptr;
};

/// Runs a callback of the module: saves an exception for later and returns 0 to stop the module.
template <typename Call>
int keep_exception(void* context, Call call) {
    auto& target = *static_cast<Target*>(context);
    try {
        call(target);
        return 1;
    } catch (...) {
        target.failure = std::current_exception();
        return 0;
    }
}

int take_header(void* context, int width, int height, int channels) {
    return keep_exception(context, [=](Target& target) {
        check_picture_size(target.path, width, height, channels);
        check_stored_values(target.path, target.format, std::uintmax_t(width) * height * channels,
                            target.size);
        check_picture_memory(target.path, width, height, channels);
        target.file.picture = {width, height, channels, {}};
    });
}

int take_attribute(void* context, const char* name, const char* text) {
    return keep_exception(context,
                          [=](Target& target) { target.file.metadata.emplace_back(name, text); });
}

std::size_t count_values(const Picture& picture) {
    return std::size_t{1} * picture.width * picture.height * picture.channels;
}

int take_rows(void* context, const float* values, std::size_t count) {
    return keep_exception(context, [=](Target& target) {
        Picture& picture = target.file.picture;
        // Address space only: pages are touched as rows arrive.
        picture.pixels.reserve(count_values(picture));
        picture.pixels.insert(picture.pixels.end(), values, values + count);
    });
}

[[noreturn]] void refuse_picture(const std::string& path, const std::string& reason,
                                 const std::string& advice) {
    throw Error(ExitCode::input, path + ": " + reason + "; " + advice);
}

/// The format by first bytes, unless the extension contradicts it; TGA has no magic number.
PictureFormat find_format(const std::string& path, InputFile& file) {
    char first_bytes[16] = {};
    file.stream.read(first_bytes, sizeof first_bytes);
    const auto count = static_cast<std::size_t>(file.stream.gcount());
    file.stream.clear();
    file.stream.seekg(0);
    if (count == 0) refuse_picture(path, "is empty", "write it again");
    const auto named = known_picture_format(path);
    const auto held = picture_format_of_bytes({first_bytes, count});
    if (held && (!named || named == held)) return *held;
    if (held) {
        const std::string what(to_string(*held));
        refuse_picture(path, "holds a picture in " + what + " format", "rename it to match");
    }
    if (named == PictureFormat::tga) return *named;
    if (named)
        refuse_picture(path, "is no " + std::string(to_string(*named)) + " picture",
                       "write it again");
    refuse_picture(path, "is not a picture we can read",
                   "give a PNG, EXR, PFM, TIFF, JPEG, WebP, HDR, TGA, BMP, PNM or DPX file");
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

PictureFile read_with_module(const std::string& path, PictureFormat format, InputFile file) {
    if (format == PictureFormat::jpeg) check_jpeg_end(path, file);
    Target target{path, format, file.size};
    const module::PictureSink sink{&target, take_header, take_attribute, take_rows};
    char error[1024] = "";
    const module::Module& library = picture_module(format, ExitCode::input);
    const int ok = library.decode(path.c_str(), module_name(format), &sink, {error, sizeof error});
    if (target.failure) std::rethrow_exception(target.failure);
    if (ok != 0) {
        const Picture& picture = target.file.picture;
        if (picture.pixels.size() == count_values(picture)) return std::move(target.file);
        refuse_picture(path, "has fewer or more pixels than its header says", "write it again");
    }
    refuse_picture(path, "cannot read the picture: " + one_line(error),
                   "the file may be damaged: write it again");
}

}  // namespace

PictureFile read_picture_file(const std::string& path) try {
    InputFile file = open_input_file(path);
    const PictureFormat format = find_format(path, file);
    if (format == PictureFormat::png) return read_png(path, file.stream, file.size);
    if (format == PictureFormat::pfm) return {read_pfm(path, std::move(file)), {}};
    return read_with_module(path, format, std::move(file));
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::limit,
                path + ": not enough memory for its pixels; scale the picture down first");
}

Picture read_picture(const std::string& path) { return read_picture_file(path).picture; }

}  // namespace rt
