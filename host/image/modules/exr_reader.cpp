// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <tuple>

#include "host/image/modules/exr_file.h"
#include "host/image/modules/exr_limits.h"
#include "host/image/modules/exr_threads.h"

namespace rt {
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

}  // namespace

PictureFile decode_exr(const std::string& path, const char* /*format*/, const CheckSize& check) {
    std::ifstream stream(path, std::ios::binary);
    const ExrSize size = check_exr_headers(stream, std::filesystem::file_size(path));
    check(size.width, size.height, size.channels);
    const ExrThreads threads(size.height);
    Imf::InputFile file(path.c_str(), threads.count());
    PictureFile result{{size.width, size.height, size.channels, {}}, texts_in(file.header())};
    read_rows(file, result.picture);
    return result;
}

}  // namespace rt
