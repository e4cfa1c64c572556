// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "host/image/input_file.h"
#include "host/image/png_file.h"

namespace rt {
namespace {

/// As in the writer: libpng reports errors by longjmp, so functions that call setjmp hold nothing
/// that needs a destructor.
class PngReader {
   public:
    PngReader(const std::string& path, std::istream& stream) : path_(path), stream_(stream) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, stop, ignore);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    PictureFile read(std::uintmax_t file_size) {
        check(read_header());
        const auto width = static_cast<int>(png_get_image_width(png_, info_));
        const auto height = static_cast<int>(png_get_image_height(png_, info_));
        // After expansion: a palette is 3 channels, a transparent color one more.
        const bool has_palette = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
        const bool has_key = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        const int channels = (has_palette ? 3 : png_get_channels(png_, info_)) + (has_key ? 1 : 0);
        check_picture_size(path_, width, height, channels);
        // Deflate's best ratio is 1032:1.
        const std::uintmax_t stored = png_get_rowbytes(png_, info_) * std::uintmax_t(height);
        check_stored_size(path_, stored, 1032, file_size);
        check_picture_memory(path_, width, height, channels);

        check(expand());
        PictureFile file{{width, height, channels, {}}, {}};
        if (png_get_channels(png_, info_) != channels) fail("inconsistent header");
        read_pixels(file.picture);
        check(read_end());
        file.metadata = texts();
        return file;
    }

   private:
    [[noreturn]] static void stop(png_structp png, png_const_charp reason) {
        auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
        std::snprintf(reader.error_, sizeof reader.error_, "%s", reason);
        png_longjmp(png, 1);
    }

    static void ignore(png_structp, png_const_charp) {}

    static void read_bytes(png_structp png, png_bytep bytes, std::size_t count) {
        std::istream& stream = static_cast<PngReader*>(png_get_io_ptr(png))->stream_;
        stream.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(count));
        if (!stream) png_error(png, "unexpected end of file");
    }

    [[noreturn]] void fail(const char* reason) const { refuse_damaged(path_, reason); }

    void check(bool done) const {
        if (!done) fail(error_);
    }

    bool read_header() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_read_fn(png_, this, read_bytes);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // we check the size ourselves
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION  // bad checksums would stop nearly all inputs
        png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
#endif
        png_read_info(png_, info_);
        return true;
    }

    bool expand() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_expand(png_);
        png_set_swap(png_);  // to this machine's byte order
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    bool read_row(png_bytep row) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_read_row(png_, row, nullptr);
        return true;
    }

    bool read_end() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_read_end(png_, info_);
        return true;
    }

    void read_pixels(Picture& picture) {
        const bool is_wide = png_get_bit_depth(png_, info_) == 16;
        const std::size_t values = static_cast<std::size_t>(picture.width) * picture.channels;
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        const bool interlaced = png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
        picture.pixels.reserve(values * picture.height);  // pages are touched as rows arrive
        std::vector<png_byte> bytes(interlaced ? row_bytes * picture.height : row_bytes);
        // Each pass but the last leaves gaps in all rows.
        for (int pass = interlaced ? 7 : 1; pass > 1; --pass) {
            for (int y = 0; y < picture.height; ++y) check(read_row(&bytes[row_bytes * y]));
        }
        for (int y = 0; y < picture.height; ++y) {
            png_bytep row = interlaced ? &bytes[row_bytes * y] : bytes.data();
            check(read_row(row));
            is_wide ? append_wide(row, values, picture.pixels)
                    : append_narrow(row, values, picture.pixels);
        }
    }

    static void append_narrow(png_const_bytep row, std::size_t count, std::vector<float>& pixels) {
        static const std::array<float, 256> shares = [] {
            std::array<float, 256> table{};
            for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(i) / 255.0f;
            return table;
        }();
        for (std::size_t i = 0; i < count; ++i) pixels.push_back(shares[row[i]]);
    }

    static void append_wide(png_const_bytep row, std::size_t count, std::vector<float>& pixels) {
        for (std::size_t i = 0; i < count; ++i) {
            std::uint16_t value = 0;
            std::memcpy(&value, row + 2 * i, sizeof value);
            pixels.push_back(static_cast<float>(value) / 65535.0f);
        }
    }

    PictureMetadata texts() const {
        png_textp chunks = nullptr;
        const int count = png_get_text(png_, info_, &chunks, nullptr);
        PictureMetadata metadata;
        for (int i = 0; i < count; ++i) metadata.emplace_back(chunks[i].key, chunks[i].text);
        return metadata;
    }

    const std::string& path_;
    std::istream& stream_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    char error_[200] = "";
};

}  // namespace

PictureFile read_png(const std::string& path, std::istream& stream, std::uintmax_t size) {
    return PngReader(path, stream).read(size);
}

}  // namespace rt
