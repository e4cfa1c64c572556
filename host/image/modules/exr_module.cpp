// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>

#include "host/image/picture_module.h"

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
        Number value{};
        take(sizeof(value));
        stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
        if (!stream_) refuse("its header ends too early");
        return value;
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

/// Parses the headers of an OpenEXR file and throws std::runtime_error for anything that would make
/// the library allocate without bound: sizes that the file is too small for, or blocks or tiles
/// much larger than the picture. Returns the header of the first part.
HeaderLimits check_exr_headers(std::istream& stream, std::uint64_t file_size) {
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
    return first;
}

bool start(int count) {
    try {
        Imf::setGlobalThreadCount(count);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

/// Runs OpenEXR with one thread per core while a picture is compressed or decompressed; with no
/// extra threads if it has few rows or the system can start no more.
class ExrThreads {
   public:
    explicit ExrThreads(int rows) {
        constexpr int rows_per_thread = 64;  // four blocks of rows, which are compressed as one
        const int cores = static_cast<int>(std::thread::hardware_concurrency());
        const int count = std::min(cores, rows / rows_per_thread);
        if (count > 1 && start(count)) count_ = count;
    }
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;
    ~ExrThreads() {
        if (count_ > 0) start(0);
    }

    int count() const { return count_; }

   private:
    int count_ = 0;
};

class MemoryStream : public Imf::OStream {
   public:
    explicit MemoryStream(std::vector<std::byte>& bytes) : OStream("memory"), bytes_(bytes) {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (bytes_.size() < place_ + size) bytes_.resize(place_ + size);
        std::memcpy(bytes_.data() + place_, bytes, size);
        place_ += size;
    }
    std::uint64_t tellp() override { return place_; }
    void seekp(std::uint64_t place) override { place_ = place; }

   private:
    std::vector<std::byte>& bytes_;
    std::uint64_t place_ = 0;
};

std::vector<std::string> names_of_channels(const Picture& picture) {
    if (!picture.channel_names.empty()) return picture.channel_names;
    constexpr std::string_view usual[] = {"Y", "YA", "RGB", "RGBA"};
    std::vector<std::string> names;
    for (const char letter : usual[picture.channels - 1]) names.emplace_back(1, letter);
    return names;
}

/// 32-bit float, zip, no date.
std::vector<std::byte> encode_exr(const EncodeRequest& request) {
    const Picture& picture = request.picture;
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 2;  // 3 % larger than the library's 4, in two thirds of the time
    for (const auto& [name, text] : request.metadata) {
        if (!text.empty()) header.insert(name, Imf::StringAttribute(text));
    }
    Imf::FrameBuffer buffer;
    auto* first = reinterpret_cast<char*>(const_cast<float*>(picture.pixels.data()));
    const std::size_t step = sizeof(float) * static_cast<std::size_t>(picture.channels);
    for (const std::string& name : names_of_channels(picture)) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, first, step,
                                       step * static_cast<std::size_t>(picture.width)));
        first += sizeof(float);
    }
    std::vector<std::byte> bytes;
    // Reserves address space only, so that growing never copies: most files are smaller than this.
    bytes.reserve(sizeof(float) * picture.pixels.size());
    {
        const ExrThreads threads(picture.height);
        MemoryStream stream(bytes);
        Imf::OutputFile file(stream, header, threads.count());
        file.setFrameBuffer(buffer);
        file.writePixels(picture.height);
    }
    return bytes;
}

/// Red before green before blue, then the rest; layers ("diffuse.R") after the picture itself.
std::tuple<std::string, std::size_t, std::string> place_of(const std::string& name) {
    static constexpr std::array<const char*, 5> order{"R", "G", "B", "Y", "A"};
    const std::size_t dot = name.rfind('.');
    const std::string layer = dot == name.npos ? "" : name.substr(0, dot);
    const std::string last = dot == name.npos ? name : name.substr(dot + 1);
    const auto found = std::find(order.begin(), order.end(), last);
    return {layer, static_cast<std::size_t>(found - order.begin()), last};
}

std::vector<std::string> channel_names(const Imf::Header& header) {
    std::vector<std::string> names;
    const Imf::ChannelList& list = header.channels();
    for (auto channel = list.begin(); channel != list.end(); ++channel) {
        names.emplace_back(channel.name());
    }
    std::sort(names.begin(), names.end(),
              [](const auto& a, const auto& b) { return place_of(a) < place_of(b); });
    return names;
}

PictureMetadata texts_in(const Imf::Header& header) {
    PictureMetadata metadata;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text != nullptr) metadata.emplace_back(attribute.name(), text->value().c_str());
    }
    return metadata;
}

/// Reads the picture in bands of rows, so that a truncated file costs no more memory than it fills.
void read_rows(Imf::InputFile& file, Picture& picture) {
    const Imath::Box2i window = file.header().dataWindow();
    const std::vector<std::string> names = channel_names(file.header());
    const auto width = static_cast<std::size_t>(picture.width);
    const std::size_t row = width * names.size();
    if (window.max.x - window.min.x + 1 != picture.width ||
        window.max.y - window.min.y + 1 != picture.height ||
        names.size() != static_cast<std::size_t>(picture.channels)) {
        throw std::runtime_error("its headers disagree on the size");
    }
    constexpr std::size_t band_values = std::size_t{1} << 24;
    const int most_rows = static_cast<int>(std::clamp<std::size_t>(band_values / row, 16, 256));
    for (int first = window.min.y; first <= window.max.y; first += most_rows) {
        const int rows = std::min(most_rows, window.max.y - first + 1);
        const std::size_t start = picture.pixels.size();
        picture.pixels.resize(start + row * static_cast<std::size_t>(rows));
        float* const band = picture.pixels.data() + start;
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); ++c) {
            buffer.insert(names[c],
                          Imf::Slice::Make(Imf::FLOAT, band + c, Imath::V2i(window.min.x, first),
                                           static_cast<std::int64_t>(width), rows,
                                           sizeof(float) * names.size(), sizeof(float) * row));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(first, first + rows - 1);
        picture.pixels.reserve(row *
                               static_cast<std::size_t>(picture.height));  // address space only
    }
}

/// The first part of the file as floats, color channels first.
PictureFile decode_exr(const std::string& path, const char* /*format*/, const CheckSize& check) {
    std::ifstream stream(path, std::ios::binary);
    const HeaderLimits header = check_exr_headers(stream, std::filesystem::file_size(path));
    const auto width = static_cast<int>(header.width()), height = static_cast<int>(header.height());
    const auto channels = static_cast<int>(header.channels.size());
    const bool wants_pixels = check(width, height, channels);
    const ExrThreads threads(height);
    Imf::InputFile file(path.c_str(), threads.count());
    PictureFile result{{width, height, channels, {}}, texts_in(file.header())};
    if (wants_pixels) read_rows(file, result.picture);
    return result;
}

}  // namespace
}  // namespace rt

extern "C" [[gnu::visibility("default")]] const void* mirrorball_module() {
    static constexpr rt::PictureModule module{rt::PictureModule::current_version, rt::encode_exr,
                                              rt::decode_exr};
    return &module;
}
