// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "host/image/picture.h"

// Scratch files and test pictures.
namespace rt {

/// Gives each test an empty directory of its own.
class ScratchFolder : public testing::Test {
   protected:
    ScratchFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "mirrorball-image-XXXXXX").string();
        directory_ = ::mkdtemp(name.data());
    }
    ~ScratchFolder() override { std::filesystem::remove_all(directory_); }

    std::string path(const std::string& name) const { return (directory_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(directory_),
                          std::filesystem::directory_iterator()));
    }

    std::filesystem::path directory_;
};

inline std::string contents(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void put(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::vector<std::uint32_t> bits(const Picture& picture) {
    std::vector<std::uint32_t> result;
    for (const float value : picture.pixels) result.push_back(std::bit_cast<std::uint32_t>(value));
    return result;
}

/// Values that a film can hold but 8 bits cannot, no two rows alike.
inline Picture difficult_picture(int channels = 3) {
    using Limits = std::numeric_limits<float>;
    const float values[] = {0.0f,
                            -0.0f,
                            1.0f,
                            -1.5f,
                            1e30f,
                            -1e-30f,
                            0.1f,
                            2.0f,
                            Limits::min(),
                            Limits::max(),
                            Limits::lowest(),
                            Limits::denorm_min(),
                            1e-41f,
                            -3e-42f,
                            0.333333f};
    Picture picture{5, 3, channels, {}};
    for (int i = 0; i < 15 * channels; ++i) picture.pixels.push_back(values[(i * 7 + i / 15) % 15]);
    return picture;
}

inline Picture ramp_picture(int width, int height) {
    Picture picture{width, height, 3, {}};
    for (int i = 0; i < width * height * 3; ++i) picture.pixels.push_back(i % 251 / 250.0f);
    return picture;
}

}  // namespace rt
