// SPDX-License-Identifier: Apache-2.0
#include "host/image/modules/exr_limits.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>

namespace rt {
namespace {

[[noreturn]] void refuse(const char* reason) { throw std::runtime_error(reason); }

/// The fields of one header that the limits depend on.
struct HeaderLimits {
    std::array<std::int32_t, 4> window{0, 0, -1, -1};  ///< first x and y, last x and y
    std::set<std::string> channels;                    ///< their names
    std::uint64_t pixel_bytes = 0;
    std::uint32_t tile_width = 0, tile_height = 0;
    std::uint32_t blocks = 0;  ///< chunkCount, where given
    std::uint8_t compression = 0;

    std::int64_t width() const { return std::int64_t{window[2]} - window[0] + 1; }
    std::int64_t height() const { return std::int64_t{window[3]} - window[1] + 1; }
};

/// Numbers in EXR are little-endian, like the machines this runs on.
class Bytes {
   public:
    Bytes(std::istream& stream, std::uint64_t file_size) : stream_(stream), left_(file_size) {}

    template <typename Number>
    Number number() {
        std::array<unsigned char, sizeof(Number)> bytes{};
        take(bytes.size());
        stream_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        if (!stream_) refuse("its header ends too early");
        std::uint64_t value = 0;
        for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
        return static_cast<Number>(value);
    }

    std::string text() {
        constexpr std::size_t longest = 255;
        std::string text;
        while (const char c = number<char>()) {
            if (text.size() == longest) refuse("a name in its header is too long");
            text += c;
        }
        return text;
    }

    void skip(std::uint64_t count) {
        take(count);
        stream_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
    }

    std::uint64_t left() const { return left_; }

   private:
    void take(std::uint64_t count) {
        if (count > left_) refuse("its header ends too early");
        left_ -= count;
    }

    std::istream& stream_;
    std::uint64_t left_;
};

void read_channels(Bytes& bytes, HeaderLimits& header) {
    constexpr std::array<std::uint64_t, 3> sizes{4, 2, 4};  // unsigned, half, float
    for (std::string name = bytes.text(); !name.empty(); name = bytes.text()) {
        if (!header.channels.insert(name).second) refuse("two channels have the same name");
        const auto type = bytes.number<std::uint32_t>();
        if (type >= sizes.size()) refuse("a channel of unknown type");
        bytes.number<std::uint32_t>();  // pLinear
        const auto x_sampling = bytes.number<std::int32_t>();
        const auto y_sampling = bytes.number<std::int32_t>();
        if (x_sampling != 1 || y_sampling != 1) refuse("it has subsampled channels");
        header.pixel_bytes += sizes[type];
    }
}

/// Reads the attributes up to the empty name that ends them; returns whether there were any.
bool read_header(Bytes& bytes, HeaderLimits& header) {
    bool any = false;
    for (std::string name = bytes.text(); !name.empty(); name = bytes.text()) {
        any = true;
        const std::string type = bytes.text();
        const auto size = bytes.number<std::int32_t>();
        if (size < 0 || static_cast<std::uint64_t>(size) > bytes.left()) {
            refuse("its header ends too early");
        }
        const std::uint64_t end = bytes.left() - static_cast<std::uint64_t>(size);
        if (name == "channels" && type == "chlist") {
            read_channels(bytes, header);
        } else if (name == "dataWindow" && size == 16) {
            for (std::int32_t& number : header.window) number = bytes.number<std::int32_t>();
        } else if (name == "compression" && size == 1) {
            header.compression = bytes.number<std::uint8_t>();
        } else if (name == "tiles" && size == 9) {
            header.tile_width = bytes.number<std::uint32_t>();
            header.tile_height = bytes.number<std::uint32_t>();
        } else if (name == "chunkCount" && size == 4) {
            header.blocks = bytes.number<std::uint32_t>();
        } else if (type == "preview" && size >= 8) {
            const std::uint64_t width = bytes.number<std::uint32_t>();
            const std::uint64_t pixels = width * bytes.number<std::uint32_t>();
            if (pixels > static_cast<std::uint64_t>(size) / 4) refuse("its preview is truncated");
        }
        if (bytes.left() < end) refuse("an attribute is larger than declared");
        bytes.skip(bytes.left() - end);
    }
    return any;
}

struct Compression {
    std::uint64_t best_ratio;  ///< a generous upper bound on the compression ratio
    std::uint64_t rows;        ///< compressed together
};

Compression compression_of(const HeaderLimits& header) {
    constexpr std::array<Compression, 10> kinds{{{1, 1},           // none
                                                 {64, 1},          // RLE
                                                 {2000, 1},        // ZIPS
                                                 {2000, 16},       // ZIP
                                                 {2000, 32},       // PIZ
                                                 {2000, 16},       // PXR24
                                                 {16, 32},         // B44
                                                 {16, 32},         // B44A
                                                 {200000, 32},     // DWAA
                                                 {200000, 256}}};  // DWAB
    if (header.compression >= kinds.size()) refuse("its compression method is unknown");
    return kinds[header.compression];
}

/// The library holds a whole block of rows, or row of tiles, in memory.
void check_blocks(const HeaderLimits& header, const Compression& compression, std::uint64_t pixels,
                  std::uint64_t file_size) {
    const auto width = static_cast<std::uint64_t>(header.width());
    const auto height = static_cast<std::uint64_t>(header.height());
    std::uint64_t block = width * compression.rows;
    std::uint64_t blocks = (height + compression.rows - 1) / compression.rows;
    if (header.tile_width != 0 || header.tile_height != 0) {
        const std::uint64_t tile_width = header.tile_width;
        const std::uint64_t tile_height = header.tile_height;
        if (tile_width == 0 || tile_height == 0) refuse("its tiles are empty");
        const bool is_huge = tile_width > 65536 || tile_height > 65536;
        if (is_huge) refuse("its tiles are too large");
        block = std::max(width, tile_width) * tile_height;
        blocks =
            ((width + tile_width - 1) / tile_width) * ((height + tile_height - 1) / tile_height);
    }
    if (block * header.pixel_bytes > 4 * pixels * header.pixel_bytes + (std::uint64_t{1} << 27)) {
        refuse("its tiles are too large");
    }
    constexpr std::uint64_t place_bytes = 8;  // each block's offset in the file
    blocks = std::max<std::uint64_t>(blocks, header.blocks);
    if (blocks * place_bytes > file_size) refuse("it is too short for its size");
}

void check(const HeaderLimits& header, std::uint64_t file_size) {
    constexpr std::int64_t largest_side = 65536;
    constexpr std::uint64_t most_channels = 1024;
    if (header.width() < 1 || header.height() < 1 || header.channels.empty()) {
        refuse("it has no pixels");
    }
    if (header.width() > largest_side || header.height() > largest_side ||
        header.channels.size() > most_channels) {
        refuse("it is too large");
    }
    const Compression compression = compression_of(header);
    const auto pixels = static_cast<std::uint64_t>(header.width() * header.height());
    if (pixels * header.pixel_bytes / compression.best_ratio > file_size) {
        refuse("it is too short for its size");
    }
    check_blocks(header, compression, pixels, file_size);
}

}  // namespace

ExrSize check_exr_headers(std::istream& stream, std::uint64_t file_size) {
    constexpr std::uint32_t deep = 0x800, many_parts = 0x1000;
    Bytes bytes(stream, file_size);
    if (bytes.number<std::uint32_t>() != 20000630) refuse("it is not an EXR file");
    const auto version = bytes.number<std::uint32_t>();
    if ((version & 0xff) != 2) refuse("its version is unknown");
    if ((version & deep) != 0) refuse("it has deep pixels");
    HeaderLimits first;
    read_header(bytes, first);
    check(first, file_size);
    for (bool more = (version & many_parts) != 0; more;) {
        HeaderLimits other;
        more = read_header(bytes, other);
        if (more) check(other, file_size);
    }
    return {static_cast<int>(first.width()), static_cast<int>(first.height()),
            static_cast<int>(first.channels.size())};
}

}  // namespace rt
