// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rt {

/// A picture in memory: linear light, unclamped, channels interleaved, row 0 at the top.
/// Holds width * height * channels floats.
struct Picture {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<float> pixels;
    std::vector<std::string> channel_names = {};  ///< for .exr, any number; empty: Y or RGB
};

inline bool have_same_shape(const Picture& a, const Picture& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels;
}

/// What a picture file says about itself: (name, text) pairs.
using PictureMetadata = std::vector<std::pair<std::string, std::string>>;

/// The name of the text that tells the scene of a picture.
inline constexpr const char* scene_hash_key = "mirrorball:SceneHash";

/// The text of that name; empty if there is none.
inline std::string text_in(const PictureMetadata& metadata, std::string_view name) {
    const auto found = std::ranges::find(metadata, name, &PictureMetadata::value_type::first);
    return found == metadata.end() ? "" : found->second;
}

struct PictureFile {
    Picture picture;
    PictureMetadata metadata;
};

}  // namespace rt
