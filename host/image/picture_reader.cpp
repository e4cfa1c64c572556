// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "host/error.h"
#include "host/image/input_file.h"
#include "host/image/oiio_loader.h"
#include "host/image/pfm_file.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"

namespace rt {
namespace {

/// What the module fills, and what went wrong on our side of the border.
struct Target {
    const std::string& path;
    Picture picture;
    PictureMetadata metadata;
    std::exception_ptr failure;
};

/// Runs a callback of the module: an exception is kept for later, 0 makes the module stop.
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
        target.picture = {width, height, channels, {}};
    });
}

int take_attribute(void* context, const char* name, const char* text) {
    return keep_exception(context,
                          [=](Target& target) { target.metadata.emplace_back(name, text); });
}

int take_rows(void* context, const float* values, std::size_t count) {
    return keep_exception(context, [=](Target& target) {
        const Picture& picture = target.picture;
        // Address space only: pages are touched as rows arrive.
        target.picture.pixels.reserve(static_cast<std::size_t>(picture.width) * picture.height *
                                      picture.channels);
        target.picture.pixels.insert(target.picture.pixels.end(), values, values + count);
    });
}

std::string_view find_format(const std::string& path) {
    InputFile file = open_input_file(path);
    char first_bytes[16] = {};
    file.stream.read(first_bytes, sizeof first_bytes);
    const auto count = static_cast<std::size_t>(file.stream.gcount());
    const std::string_view format = picture_format_of_bytes({first_bytes, count});
    if (format.empty()) {
        throw Error(ExitCode::input,
                    path + (count == 0 ? ": is empty" : ": is not a picture we can read") +
                        "; give a PNG, EXR, PFM, JPEG, TIFF, HDR or PNM file");
    }
    return format;
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

void read_with_library(Target& target, std::string_view format, bool with_pixels) {
    const oiio::PictureSink sink{&target, take_header, take_attribute,
                                 with_pixels ? take_rows : nullptr};
    char error[1024] = "";
    const oiio::Module& library = image_library(ExitCode::input);
    const int ok = library.decode(target.path.c_str(), std::string(format).c_str(), &sink,
                                  {error, sizeof error});
    if (target.failure) std::rethrow_exception(target.failure);
    if (ok != 0) return;
    throw Error(ExitCode::input, target.path + ": cannot read the picture: " + one_line(error) +
                                     "; the file may be damaged: write it again");
}

}  // namespace

Picture read_picture(const std::string& path) try {
    const std::string_view format = find_format(path);
    if (format == "pfm") return read_pfm(path);
    Target target{path, {}, {}, {}};
    read_with_library(target, format, true);
    return std::move(target.picture);
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::limit, path + ": not enough memory to read it; scale it down first");
}

PictureMetadata read_picture_metadata(const std::string& path) {
    const std::string_view format = find_format(path);
    if (format == "pfm") return {};
    Target target{path, {}, {}, {}};
    read_with_library(target, format, false);
    return std::move(target.metadata);
}

}  // namespace rt
