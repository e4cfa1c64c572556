// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// The interface between the program and its picture modules: libmirrorball_exr.so, which links
/// OpenEXR, and libmirrorball_oiio.so, which links OpenImageIO. Plain C on purpose: no exception
/// and no owned memory crosses it. Functions return 1 for success; 0 leaves a message in `error`,
/// or none when a callback asked to stop.
namespace rt::module {

/// Raised whenever anything below changes; the program refuses a module of another version.
constexpr std::uint32_t interface_version = 3;
constexpr const char* entry_point_name = "mirrorball_picture_module";

struct EncodeRequest {
    const char* format;  // OpenImageIO's name, such as "jpeg"
    int width;
    int height;
    int channels;
    const char* const* channel_names;  // null: the default names
    int is_float;                      // pixels of 32-bit float, else of 8 bits
    const void* pixels;                // row 0 on top, interleaved
    const char* color_space;  // what the file declares, in OpenImageIO's terms; null for none
    std::size_t attribute_count;
    const char* const* attribute_names;
    const char* const* attribute_texts;
};

/// Callbacks must not throw; 0 stops the module.
struct ByteSink {
    void* context;
    /// Writes bytes at an offset in the file, overwriting what is there.
    int (*write)(void* context, std::uint64_t place, const unsigned char* bytes, std::size_t count);
};

/// Called in this order: header once, attribute for each text, rows until all pixels are sent.
struct PictureSink {
    void* context;
    int (*header)(void* context, int width, int height, int channels);
    int (*attribute)(void* context, const char* name, const char* text);
    int (*rows)(void* context, const float* values, std::size_t count);  // null: header only
};

struct ErrorText {
    char* text;  // zero-terminated on return
    std::size_t size;
};

struct Module {
    std::uint32_t version;
    int (*encode)(const EncodeRequest* request, const ByteSink* sink, ErrorText error);
    int (*decode)(const char* path, const char* format, const PictureSink* sink, ErrorText error);
};

}  // namespace rt::module
