// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/image/picture_io.h"
#include "host/image/picture_module.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

using WritePicture = ScratchFolder;

std::string text_of(const PictureMetadata& metadata, const std::string& name) {
    for (const auto& [key, text] : metadata) {
        if (key == name) return text;
    }
    return "(none)";
}

TEST_F(WritePicture, FloatFilesKeepEveryBit) {
    for (const int channels : {1, 3}) {
        const Picture picture = difficult_picture(channels);
        for (const char* name : {"a.exr", "a.pfm"}) {
            write_picture(path(name), picture, Encoding::srgb);
            const Picture back = read_picture(path(name));
            EXPECT_EQ(back.width, 5);
            EXPECT_EQ(back.height, 3);
            EXPECT_EQ(back.channels, channels) << name;
            EXPECT_EQ(bits(back), bits(picture)) << name;
        }
    }
}

TEST_F(WritePicture, NonFiniteValuesSurviveInFloatFiles) {
    Picture picture{2, 1, 1, {std::numeric_limits<float>::infinity(), std::nanf("")}};
    for (const char* name : {"a.exr", "a.pfm"}) {
        write_picture(path(name), picture, Encoding::display);
        EXPECT_EQ(bits(read_picture(path(name))), bits(picture)) << name;
    }
}

TEST_F(WritePicture, PfmIsLittleEndianAndStartsAtTheBottom) {
    write_picture(path("a.pfm"), {1, 2, 1, {1.0f, 2.0f}}, Encoding::display);
    EXPECT_EQ(contents(path("a.pfm")), std::string("Pf\n1 2\n-1.0\n\0\0\0\x40\0\0\x80\x3f", 20));
}

TEST_F(WritePicture, PngRoundsToTheNearestOf255) {
    // Either side of every boundary (k + 0.5) / 255: the product is exact in long double.
    Picture picture{255, 2, 1, {}};
    std::vector<int> expected;
    for (const float end : {0.0f, 1.0f}) {
        for (int k = 0; k < 255; ++k) {
            const auto boundary = static_cast<float>((k + 0.5L) / 255.0L);
            const float value = std::nextafter(boundary, end);
            picture.pixels.push_back(value);
            expected.push_back(value * 255.0L >= k + 0.5L ? k + 1 : k);
        }
    }
    for (const Encoding encoding : {Encoding::display, Encoding::linear}) {
        write_picture(path("a.png"), picture, encoding);
        const Picture back = read_picture(path("a.png"));
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(back.pixels[i], static_cast<float>(expected[i]) / 255.0f) << i;
        }
    }
}

TEST_F(WritePicture, OpenImageIoWritesOtherFormats) {
    Picture picture{40, 30, 3, {}};
    for (int i = 0; i < 40 * 30; ++i) {
        for (const float value : {i % 40 / 39.0f, i / 40 / 29.0f, 0.5f}) {
            picture.pixels.push_back(value);
        }
    }
    const float rounding = 0.5f / 255 * 1.001f, lossy = 0.04f;
    const std::pair<const char*, float> formats[] = {
        {"a.tif", 0.0f},     {"a.TIFF", 0.0f},    {"a.bmp", rounding},
        {"a.tga", rounding}, {"a.ppm", rounding}, {"a.hdr", 1 / 100.0f},
        {"a.jpg", lossy},    {"a.webp", lossy},   {"a.dpx", rounding},
    };
    for (const auto& [name, tolerance] : formats) {
        write_picture(path(name), picture, Encoding::display);
        const Picture back = read_picture(path(name));
        ASSERT_EQ(back.width, 40) << name;
        ASSERT_EQ(back.height, 30) << name;
        ASSERT_EQ(back.channels, 3) << name;
        float worst = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            worst = std::max(worst, std::abs(back.pixels[i] - picture.pixels[i]));
        }
        EXPECT_LE(worst, tolerance) << name;
    }
}

TEST_F(WritePicture, SrgbBytesAreThoseOfTheCurve) {
    Picture picture{0, 1, 1, {}};
    for (std::uint32_t bits = 1; bits < std::bit_cast<std::uint32_t>(1.0f); bits += 9973) {
        picture.pixels.push_back(std::bit_cast<float>(bits));
    }
    for (int k = 0; k < 255; ++k) {  // the curve's inverse: near the boundaries between bytes
        const double stored = (k + 0.5) / 255;
        const double linear =
            stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
        const auto boundary = static_cast<float>(linear);
        for (const float value :
             {std::nextafter(boundary, 0.0f), boundary, std::nextafter(boundary, 1.0f)}) {
            picture.pixels.push_back(value);
        }
    }
    picture.width = static_cast<int>(picture.pixels.size());
    const std::vector<std::uint8_t> bytes = encode_8bit(picture, Encoding::srgb);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const double stored = srgb_from_linear(picture.pixels[i]);
        ASSERT_EQ(bytes[i], static_cast<int>(stored * 255 + 0.5)) << picture.pixels[i];
    }
}

TEST_F(WritePicture, PngKeepsRowsAndChannelsInPlace) {
    Picture picture = ramp_picture(3, 2);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = i / 255.0f;
    write_picture(path("a.png"), picture, Encoding::display);
    EXPECT_EQ(bits(read_picture(path("a.png"))), bits(picture));
}

TEST_F(WritePicture, SamePictureGivesTheSameBytes) {
    const PictureMetadata metadata{{"mirrorball:Scene", "spheres"}, {"mirrorball:Rays", "7"}};
    const char* const names[] = {"a.png",  "a.exr", "a.pfm", "a.tif", "a.jpg", "a.hdr",
                                 "a.webp", "a.tga", "a.bmp", "a.ppm", "a.dpx"};
    for (const char* name : names) {
        write_picture(path(name), ramp_picture(40, 30), Encoding::srgb, metadata);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (const std::string name : names) {
        const std::string other = path("b" + name.substr(1));
        write_picture(other, ramp_picture(40, 30), Encoding::srgb, metadata);
        EXPECT_EQ(contents(path(name)), contents(other)) << name;
        const PictureMetadata back = read_picture_file(other).metadata;
        EXPECT_EQ(text_of(back, "DateTime"), "(none)") << name;
        EXPECT_EQ(text_of(back, "capDate"), "(none)") << name;
    }
}

TEST_F(WritePicture, OnlyDeclaredEncodingsAreInTheFile) {
    const auto chunks = [&](Encoding encoding) {
        write_picture(path("a.png"), ramp_picture(2, 2), encoding);
        const std::string bytes = contents(path("a.png"));
        return std::pair(bytes.find("sRGB") != bytes.npos, bytes.find("gAMA") != bytes.npos);
    };
    EXPECT_EQ(chunks(Encoding::display), std::pair(false, false));
    EXPECT_TRUE(chunks(Encoding::srgb).first);
    EXPECT_EQ(chunks(Encoding::linear), std::pair(false, true));
    const std::string bytes = contents(path("a.png"));
    const std::string gamma = bytes.substr(bytes.find("gAMA") + 4, 4);
    EXPECT_EQ(gamma, std::string("\0\1\x86\xa0", 4));  // 100000, a gamma of 1.0
}

TEST_F(WritePicture, NamesWithSpacesAndUmlautsWork) {
    const std::string name = path("zwei B\xc3\xa4lle #1 %04d.exr");
    write_picture(name, ramp_picture(2, 2), Encoding::display);
    EXPECT_EQ(read_picture(name).width, 2);
}

TEST_F(WritePicture, MetadataSurvivesInPngAndExr) {
    const PictureMetadata metadata{
        {"mirrorball:Options", "--size 64\nsecond line"},
        {"mirrorball:Scene", "Kugeln \xc3\xbc\xe2\x82\xac \"quoted\" <b>"},
        {"mirrorball:Settings", std::string(100000, 'x')},
        {"mirrorball:TwentyLettersAreFine", "1"},
        {"mirrorball:Empty", ""},
    };
    for (const char* name : {"a.png", "a.exr"}) {
        write_picture(path(name), ramp_picture(4, 4), Encoding::display, metadata);
        const PictureMetadata back = read_picture_file(path(name)).metadata;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(text_of(back, metadata[i].first), metadata[i].second) << name;
        }
        EXPECT_EQ(text_of(back, "mirrorball:Empty"), "(none)");
    }
    write_picture(path("a.pfm"), ramp_picture(4, 4), Encoding::display, metadata);
    EXPECT_TRUE(read_picture_file(path("a.pfm")).metadata.empty());
}

TEST(PictureModule, MayBeLoadedFromManyThreads) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([i] {
            picture_module(i % 2 == 0 ? PictureFormat::exr : PictureFormat::tiff, ExitCode::output);
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(picture_module(PictureFormat::exr, ExitCode::output).version,
              PictureModule::current_version);
}

}  // namespace
}  // namespace rt::this_file
