// SPDX-License-Identifier: Apache-2.0
#include "host/image/modules/exr_writer.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "host/image/modules/exr_threads.h"

namespace rt::module {
namespace {

/// Thrown when the sink refuses more bytes.
struct SinkStopped {};

class SinkStream : public Imf::OStream {
   public:
    explicit SinkStream(const ByteSink& sink) : OStream("memory"), sink_(sink) {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        const auto* first = reinterpret_cast<const unsigned char*>(bytes);
        if (sink_.write(sink_.context, place_, first, size) == 0) throw SinkStopped();
        place_ += size;
    }
    std::uint64_t tellp() override { return place_; }
    void seekp(std::uint64_t place) override { place_ = place; }

   private:
    const ByteSink& sink_;
    std::uint64_t place_ = 0;
};

const char* channel_name(const EncodeRequest& request, int channel) {
    if (request.channel_names != nullptr) return request.channel_names[channel];
    static constexpr std::array<std::array<const char*, 4>, 4> names{
        {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    return names.at(static_cast<std::size_t>(request.channels - 1))
        .at(static_cast<std::size_t>(channel));
}

Imf::Header make_header(const EncodeRequest& request) {
    Imf::Header header(request.width, request.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 2;  // 3 % larger than the library's 4, in two thirds of the time
    for (int c = 0; c < request.channels; ++c) {
        header.channels().insert(channel_name(request, c), Imf::Channel(Imf::FLOAT));
    }
    for (std::size_t i = 0; i < request.attribute_count; ++i) {
        header.insert(request.attribute_names[i], Imf::StringAttribute(request.attribute_texts[i]));
    }
    return header;
}

Imf::FrameBuffer frame_buffer(const EncodeRequest& request) {
    Imf::FrameBuffer buffer;
    auto* first = static_cast<char*>(const_cast<void*>(request.pixels));
    const std::size_t step = sizeof(float) * static_cast<std::size_t>(request.channels);
    for (int c = 0; c < request.channels; ++c) {
        buffer.insert(channel_name(request, c),
                      Imf::Slice(Imf::FLOAT, first + sizeof(float) * static_cast<std::size_t>(c),
                                 step, step * static_cast<std::size_t>(request.width)));
    }
    return buffer;
}

}  // namespace

int encode_exr(const EncodeRequest& request, const ByteSink& sink) {
    const int most = request.channel_names == nullptr ? 4 : 64;
    if (request.is_float == 0 || request.channels < 1 || request.channels > most) {
        throw std::invalid_argument(
            "EXR files are written from floats of 1 to 4 channels, or 64 with names");
    }
    const ExrThreads threads(request.height);
    try {
        SinkStream stream(sink);
        Imf::OutputFile file(stream, make_header(request), threads.count());
        file.setFrameBuffer(frame_buffer(request));
        file.writePixels(request.height);
    } catch (const SinkStopped&) {
        return 0;
    }
    return 1;
}

}  // namespace rt::module
