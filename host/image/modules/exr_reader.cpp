// SPDX-License-Identifier: Apache-2.0
#include "host/image/modules/exr_reader.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "host/image/modules/exr_limits.h"
#include "host/image/modules/exr_threads.h"

namespace rt::module {
namespace {

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

bool send_attributes(const Imf::Header& header, const PictureSink& sink) {
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text == nullptr) continue;
        if (sink.attribute(sink.context, attribute.name(), text->value().c_str()) == 0) {
            return false;
        }
    }
    return true;
}

/// Reads the picture in bands of rows, so that a truncated file costs no more memory than it fills.
bool send_rows(Imf::InputFile& file, const PictureSink& sink) {
    const Imath::Box2i window = file.header().dataWindow();
    const std::vector<std::string> names = channel_names(file.header());
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const std::size_t row = width * names.size();
    constexpr std::size_t band_values = std::size_t{1} << 24;
    const int most_rows = static_cast<int>(std::clamp<std::size_t>(band_values / row, 16, 256));
    std::vector<float> band;
    for (int first = window.min.y; first <= window.max.y; first += most_rows) {
        const int rows = std::min(most_rows, window.max.y - first + 1);
        band.assign(row * static_cast<std::size_t>(rows), 0.0f);
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); ++c) {
            buffer.insert(
                names[c],
                Imf::Slice::Make(Imf::FLOAT, band.data() + c, Imath::V2i(window.min.x, first),
                                 static_cast<std::int64_t>(width), rows,
                                 sizeof(float) * names.size(), sizeof(float) * row));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(first, first + rows - 1);
        if (sink.rows(sink.context, band.data(), band.size()) == 0) return false;
    }
    return true;
}

}  // namespace

int decode_exr(const char* path, const PictureSink& sink) {
    std::ifstream stream(path, std::ios::binary);
    const ExrSize size = check_exr_headers(stream, std::filesystem::file_size(path));
    if (sink.header(sink.context, size.width, size.height, size.channels) == 0) return 0;
    const ExrThreads threads(size.height);
    Imf::InputFile file(path, threads.count());
    return send_attributes(file.header(), sink) && send_rows(file, sink) ? 1 : 0;
}

}  // namespace rt::module
