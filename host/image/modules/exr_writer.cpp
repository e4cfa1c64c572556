// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstring>
#include <string_view>

#include "host/image/modules/exr_file.h"
#include "host/image/modules/exr_threads.h"

namespace rt {
namespace {

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

}  // namespace

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

}  // namespace rt
