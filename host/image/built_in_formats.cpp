// SPDX-License-Identifier: Apache-2.0
#include "host/image/built_in_formats.h"

#include <fmt/format.h>
#include <png.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include "host/base/error.h"
#include "host/base/memory.h"
#include "host/base/text.h"
#include "host/image/output_file.h"

namespace rt {

void refuse_picture(const std::string& path, const std::string& reason, const std::string& advice) {
    throw Error(ExitCode::input, path + ": " + reason + "; " + advice);
}

void refuse_damaged(const std::string& path, const std::string& reason) {
    refuse_picture(path, "cannot read the picture: " + reason, "it may be damaged: save it again");
}

InputFile open_input_file(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        refuse_picture(path, "cannot read: " + std::generic_category().message(errno),
                       "check the path");
    }
    if (S_ISDIR(status.st_mode)) refuse_picture(path, "is a directory", "name a picture file");
    if (!S_ISREG(status.st_mode))
        refuse_picture(path, "is not a regular file", "copy it to one first");
    errno = 0;
    InputFile file{std::ifstream(path, std::ios::binary),
                   static_cast<std::uintmax_t>(status.st_size)};
    if (!file.stream) {
        refuse_picture(path, "cannot read: " + std::generic_category().message(errno),
                       "check its permissions");
    }
    return file;
}

void check_picture_size(const std::string& path, int width, int height, int channels) {
    constexpr int largest_side = 65536;
    constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
    constexpr std::int64_t most_values = std::int64_t{1} << 30;
    const std::string size = fmt::format("{}x{} pixels of {} channels", width, height, channels);
    if (width < 1 || height < 1 || channels < 1)
        refuse_picture(path, "has " + size, "save it again");
    const std::int64_t pixels = std::int64_t{width} * height;
    if (width > largest_side || height > largest_side || pixels > most_pixels || channels > 64 ||
        pixels * channels > most_values) {
        refuse_picture(
            path, "has " + size,
            "scale it down to at most 65536 pixels per side, 2^28 pixels and 2^30 values");
    }
}

void check_picture_memory(const std::string& path, int width, int height, int channels) {
    const std::uint64_t values =
        std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels);
    check_memory(values * sizeof(float), path + ": its pixels as floats", "scale it down first");
}

namespace {

static_assert(std::endian::native == std::endian::little, "pixels are written as they are");

struct Header {
    int channels = 0;
    int width = 0;
    int height = 0;
    double scale = 0;
};

/// The next word of the header with the one white space behind it; empty when there is none.
std::string next_word(std::istream& stream) {
    constexpr std::size_t longest = 32;
    std::string word;
    for (int c = stream.get(); c != EOF && word.size() <= longest; c = stream.get()) {
        const bool is_space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (is_space) return word;
        word += static_cast<char>(c);
    }
    return {};
}

Header read_header(const std::string& path, std::istream& stream) {
    const std::string kind = next_word(stream);
    const auto width = parse_number<int>(next_word(stream));
    const auto height = parse_number<int>(next_word(stream));
    const auto scale = parse_number<double>(next_word(stream));
    if ((kind != "PF" && kind != "Pf") || !width || !height || !scale || *scale == 0 ||
        !std::isfinite(*scale)) {
        refuse_picture(
            path, "damaged PFM header: expected PF or Pf, width, height and a scale other than 0",
            "save it again");
    }
    return {kind == "PF" ? 3 : 1, *width, *height, *scale};
}

}  // namespace

void write_pfm(const std::string& path, const Picture& picture) {
    const std::string header = fmt::format("{}\n{} {}\n-1.0\n", picture.channels == 3 ? "PF" : "Pf",
                                           picture.width, picture.height);
    const auto row = static_cast<std::size_t>(picture.width) * picture.channels;
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(header)));
    for (int y = picture.height - 1; y >= 0; --y) {
        file.write(std::as_bytes(std::span(picture.pixels).subspan(row * y, row)));
    }
    file.commit();
}

Picture read_pfm(const std::string& path, InputFile file, bool with_pixels) {
    const Header header = read_header(path, file.stream);
    check_picture_size(path, header.width, header.height, header.channels);

    Picture picture{header.width, header.height, header.channels, {}};
    const auto row = static_cast<std::size_t>(header.width) * header.channels;
    const std::uintmax_t expected = row * header.height * sizeof(float);
    const auto start = static_cast<std::uintmax_t>(file.stream.tellg());
    if (file.size - start != expected) {
        refuse_picture(path,
                       fmt::format("has {} bytes of pixels, but its header declares {}",
                                   file.size - start, expected),
                       "save it again");
    }
    if (!with_pixels) return picture;
    check_picture_memory(path, header.width, header.height, header.channels);
    picture.pixels.resize(row * header.height);
    for (int y = header.height - 1; y >= 0; --y) {
        auto* target = reinterpret_cast<char*>(picture.pixels.data() + row * y);
        file.stream.read(target, static_cast<std::streamsize>(row * sizeof(float)));
    }
    if (!file.stream) refuse_picture(path, "cannot read", "check the disk");
    if (header.scale < 0) return picture;
    for (float& value : picture.pixels) {
        value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
    }
    return picture;
}

namespace {

// libpng's frames pass on exceptions, as those of all C code on x86-64: its errors leave it as
// ours.

void ignore_warning(png_structp, png_const_charp) {}

void flush_nothing(png_structp) {}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto& file = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
    const auto more = std::as_bytes(std::span(bytes, count));
    file.insert(file.end(), more.begin(), more.end());
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

/// libpng's structures for writing a file.
struct PngWriter {
    explicit PngWriter(const std::string& path) {
        const auto fail = [](png_structp failing, png_const_charp reason) {
            fail_to_encode(*static_cast<const std::string*>(png_get_error_ptr(failing)), reason);
        };
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, const_cast<std::string*>(&path), fail,
                                      ignore_warning);
        info = png == nullptr ? nullptr : png_create_info_struct(png);
        if (info == nullptr) fail_to_encode(path, "out of memory");
    }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }

    png_structp png = nullptr;
    png_infop info = nullptr;
};

class PngReader {
   public:
    PngReader(const std::string& path, std::istream& stream) : path_(path), stream_(stream) {
        const auto fail = [](png_structp failing, png_const_charp reason) {
            refuse_damaged(static_cast<PngReader*>(png_get_error_ptr(failing))->path_, reason);
        };
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    PictureFile read(bool with_pixels) {
        png_set_read_fn(png_, this, read_bytes);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // we check the size ourselves
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION  // bad checksums would stop nearly all inputs
        png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
#endif
        png_read_info(png_, info_);
        const auto width = static_cast<int>(png_get_image_width(png_, info_));
        const auto height = static_cast<int>(png_get_image_height(png_, info_));
        // After expansion: a palette is 3 channels, a transparent color one more.
        const bool has_palette = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
        const bool has_key = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        const int channels = (has_palette ? 3 : png_get_channels(png_, info_)) + (has_key ? 1 : 0);
        check_picture_size(path_, width, height, channels);
        PictureFile file{{width, height, channels, {}}, {}};
        if (with_pixels) {
            check_picture_memory(path_, width, height, channels);
            png_set_expand(png_);
            png_set_swap(png_);  // to this machine's byte order
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
            if (png_get_channels(png_, info_) != channels) {
                refuse_damaged(path_, "inconsistent header");
            }
            read_pixels(file.picture);
            png_read_end(png_, info_);
        }
        file.metadata = texts();
        return file;
    }

   private:
    static void read_bytes(png_structp png, png_bytep bytes, std::size_t count) {
        std::istream& stream = static_cast<PngReader*>(png_get_io_ptr(png))->stream_;
        stream.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(count));
        if (!stream) png_error(png, "unexpected end of file");
    }

    void read_pixels(Picture& picture) {
        const bool is_wide = png_get_bit_depth(png_, info_) == 16;
        const std::size_t values = static_cast<std::size_t>(picture.width) * picture.channels;
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        const bool interlaced = png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
        // Pages are touched as rows arrive, so that a false header costs no memory.
        picture.pixels.reserve(values * picture.height);
        const auto bytes = std::make_unique_for_overwrite<png_byte[]>(
            interlaced ? row_bytes * picture.height : row_bytes);
        // Each pass but the last leaves gaps in all rows.
        for (int pass = interlaced ? 7 : 1; pass > 1; --pass) {
            for (int y = 0; y < picture.height; ++y)
                png_read_row(png_, &bytes[row_bytes * y], nullptr);
        }
        for (int y = 0; y < picture.height; ++y) {
            png_bytep row = interlaced ? &bytes[row_bytes * y] : bytes.get();
            png_read_row(png_, row, nullptr);
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
};

}  // namespace

std::vector<std::byte> encode_png_file(
    const std::string& path, const Picture& picture, Encoding encoding,
    std::span<const std::pair<std::string, std::string>> metadata) try {
    const PngWriter writer(path);
    std::vector<std::byte> file;
    png_set_write_fn(writer.png, &file, append_bytes, flush_nothing);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), 8,
                 picture.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    choose_compression(writer.png);
    declare_encoding(writer.png, writer.info, encoding);
    std::vector<png_text> texts;
    for (const auto& [name, text] : metadata) {
        if (!text.empty()) texts.push_back(text_chunk(name, text));
    }
    png_set_text(writer.png, writer.info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(writer.png, writer.info);
    std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width) * picture.channels);
    for (int y = 0; y < picture.height; ++y) {
        encode_8bit(std::span(picture.pixels).subspan(row.size() * y, row.size()), encoding, row);
        png_write_row(writer.png, row.data());
    }
    png_write_end(writer.png, nullptr);
    return file;
} catch (const std::bad_alloc&) {
    fail_to_encode(path, "out of memory");
}

PictureFile read_png(const std::string& path, std::istream& stream, bool with_pixels) {
    return PngReader(path, stream).read(with_pixels);
}

}  // namespace rt
