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
#include <stdexcept>
#include <string_view>
#include <thread>
#include <tuple>

#include "host/image/modules/exr_limits.h"
#include "host/image/picture_module.h"

namespace rt {
namespace {

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
    const ExrSize size = check_exr_headers(stream, std::filesystem::file_size(path));
    const bool wants_pixels = check(size.width, size.height, size.channels);
    const ExrThreads threads(size.height);
    Imf::InputFile file(path.c_str(), threads.count());
    PictureFile result{{size.width, size.height, size.channels, {}}, texts_in(file.header())};
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
