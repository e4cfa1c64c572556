// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <new>

#include "host/image/output_path.h"
#include "host/image/png_file.h"

namespace rt {
namespace {

/// What the callbacks of libpng see. It reports an error by longjmp, so functions that call
/// setjmp hold nothing that needs a destructor: all of that is here.
struct PngWriter {
    const Picture& picture;
    Encoding encoding;
    std::vector<png_text> texts;
    std::vector<std::uint8_t> row;
    std::vector<std::byte> file;
    char error[200] = "";
};

[[noreturn]] void stop_writing(png_structp png, png_const_charp reason) {
    auto& writer = *static_cast<PngWriter*>(png_get_error_ptr(png));
    std::snprintf(writer.error, sizeof writer.error, "%s", reason);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void flush_nothing(png_structp) {}

bool append(std::vector<std::byte>& file, std::span<const std::byte> bytes) {
    try {
        file.insert(file.end(), bytes.begin(), bytes.end());
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto& writer = *static_cast<PngWriter*>(png_get_io_ptr(png));
    if (!append(writer.file, std::as_bytes(std::span(bytes, count)))) {
        png_error(png, "out of memory");
    }
}

int color_type(int channels) {
    constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                             PNG_COLOR_TYPE_RGB_ALPHA};
    return types[channels - 1];
}

void declare_encoding(png_structp png, png_infop info, Encoding encoding) {
    if (encoding == Encoding::srgb) {
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    }
    if (encoding == Encoding::linear) png_set_gAMA(png, info, 1.0);
}

/// Rendered pictures have many uniform areas and repeated edges: unfiltered they compress in half
/// the time of the best filter, to 1 to 13 % more bytes (docs/dependencies.md).
void choose_compression(png_structp png) {
    png_set_compression_level(png, 6);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_buffer_size(png, 1 << 18);  // the size of a chunk of pixels
}

bool write_png(png_structp png, png_infop info, PngWriter& writer) {
    const Picture& picture = writer.picture;
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, &writer, append_bytes, flush_nothing);
    png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), 8, color_type(picture.channels),
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    choose_compression(png);
    declare_encoding(png, info, writer.encoding);
    png_set_text(png, info, writer.texts.data(), static_cast<int>(writer.texts.size()));
    png_write_info(png, info);
    for (int y = 0; y < picture.height; ++y) {
        encode_8bit_row(picture, y, writer.encoding, writer.row);
        png_write_row(png, writer.row.data());
    }
    png_write_end(png, nullptr);
    return true;
}

/// tEXt holds Latin-1, iTXt UTF-8.
png_text text_chunk(const std::string& name, const std::string& text) {
    const bool is_ascii =
        std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
    png_text chunk{};
    chunk.compression = is_ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(name.c_str());
    chunk.text = const_cast<char*>(text.c_str());
    chunk.text_length = text.size();
    return chunk;
}

}  // namespace

std::vector<std::byte> encode_png_file(
    const std::string& path, const Picture& picture, Encoding encoding,
    std::span<const std::pair<std::string, std::string>> metadata) {
    PngWriter writer{picture, encoding, {}, {}, {}};
    for (const auto& [name, text] : metadata) {
        if (!text.empty()) writer.texts.push_back(text_chunk(name, text));
    }
    writer.row.resize(static_cast<std::size_t>(picture.width) * picture.channels);
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, stop_writing, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    const bool written = info != nullptr && write_png(png, info, writer);
    png_destroy_write_struct(&png, &info);
    if (written) return std::move(writer.file);
    fail_to_encode(path, writer.error[0] == '\0' ? "out of memory" : writer.error);
}

}  // namespace rt
