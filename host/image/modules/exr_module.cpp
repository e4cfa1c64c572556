// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>

#include "host/image/picture_module.h"

namespace rt {
namespace {

[[noreturn]] void refuse(const char* reason) { throw std::runtime_error(reason); }

void require(exr_result_t result) {
    if (result != EXR_ERR_SUCCESS) refuse(exr_get_default_error_message(result));
}

/// A file open in OpenEXR's core library, which reads headers strictly and never takes more memory
/// for them than the file has bytes.
class CoreFile {
   public:
    explicit CoreFile(const std::string& path) {
        exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
        settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
        settings.max_image_width = settings.max_image_height = largest_side;
        settings.max_tile_width = settings.max_tile_height = largest_side;
        require(exr_start_read(&context_, path.c_str(), &settings));
    }
    CoreFile(const CoreFile&) = delete;
    CoreFile& operator=(const CoreFile&) = delete;
    ~CoreFile() { exr_finish(&context_); }

    int parts() const {
        int count = 0;
        require(exr_get_count(context_, &count));
        return count;
    }

    int height() const {
        exr_attr_box2i_t window{};
        require(exr_get_data_window(context_, 0, &window));
        return window.max.y - window.min.y + 1;
    }

    /// Throws for a part for which the main library would allocate without bound: blocks or tiles
    /// much larger than the picture, or more of them than the file has room for.
    void check(int part, std::uint64_t file_size) const {
        exr_storage_t storage{};
        require(exr_get_storage(context_, part, &storage));
        if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
            refuse("it has deep pixels");
        }
        std::int32_t chunks = 0;
        require(exr_get_chunk_count(context_, part, &chunks));
        constexpr std::uint64_t place_bytes = 8;  // each chunk's offset in the file
        if (static_cast<std::uint64_t>(chunks) * place_bytes > file_size) {
            refuse("it is too short for its size");
        }
        std::uint64_t chunk_bytes = 0;
        require(exr_get_chunk_unpacked_size(context_, part, &chunk_bytes));
        if (chunk_bytes > std::uint64_t{1} << 30) refuse("its tiles are too large");
    }

   private:
    static constexpr int largest_side = 65536;

    exr_context_t context_ = nullptr;
};

/// How many threads compress or decompress a picture, which OpenEXR then has: one per core, or
/// none if it has few rows or the system can start no more.
int start_threads(int rows) try {
    constexpr int rows_per_thread = 64;  // four blocks of rows, which are compressed as one
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    const int count = std::min(cores, rows / rows_per_thread);
    if (count < 2) return 0;
    Imf::setGlobalThreadCount(count);
    return count;
} catch (const std::exception&) {
    return 0;
}

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
    if (picture.channels == 1) return {"Y"};
    return {"R", "G", "B"};
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
        MemoryStream stream(bytes);
        Imf::OutputFile file(stream, header, start_threads(picture.height));
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
    const CoreFile core(path);
    const std::uint64_t file_size = std::filesystem::file_size(path);
    for (int part = 0; part < core.parts(); ++part) core.check(part, file_size);
    Imf::InputFile file(path.c_str(), start_threads(core.height()));
    const Imath::Box2i window = file.header().dataWindow();
    const auto channels = static_cast<int>(channel_names(file.header()).size());
    PictureFile result{{window.size().x + 1, window.size().y + 1, channels, {}},
                       texts_in(file.header())};
    const Picture& picture = result.picture;
    const bool wants_pixels = check(picture.width, picture.height, channels);
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
