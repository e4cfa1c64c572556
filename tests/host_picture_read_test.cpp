// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "host/image/picture_io.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;
using ReadPicture = ScratchFolder;

TEST_F(ReadPicture, RefusesWhatIsNotAPicture) {
    ASSERT_EQ(::mkfifo(path("pipe.png").c_str(), 0600), 0);
    put(path("text.png"), "<html>not a picture</html>");
    put(path("empty.exr"), "");
    for (const std::string& name :
         {path("pipe.png"), directory_.string(), path("missing.png"), path("text.png"),
          path("empty.exr"), std::string("/dev/zero"), std::string()}) {
        const auto [code, message] = refusal_of([&] { read_picture(name); });
        EXPECT_EQ(code, ExitCode::input) << name;
        EXPECT_EQ(message.find(name + ": "), 0u) << message;
    }
}

TEST_F(ReadPicture, RefusesUnreadableFiles) {
    if (::geteuid() == 0) GTEST_SKIP() << "root ignores permissions";
    write_picture(path("a.png"), ramp_picture(2, 2), Encoding::display);
    fs::permissions(path("a.png"), fs::perms::none);
    EXPECT_EQ(refusal_of([&] { read_picture(path("a.png")); }).exit_code, ExitCode::input);
}

TEST_F(ReadPicture, TheExtensionTellsTheFormat) {
    write_picture(path("a.exr"), difficult_picture(), Encoding::display);
    for (const char* name : {"a.png", "a.tif", "a.tga", "a.pfm", "a.jpg", "a", "a.text"}) {
        fs::copy_file(path("a.exr"), path(name));
        const auto [code, message] = refusal_of([&] { read_picture(path(name)); });
        EXPECT_EQ(code, ExitCode::input) << name;
        EXPECT_EQ(message.find(path(name) + ": "), 0u) << message;
    }
}

TEST_F(ReadPicture, RefusesPicturesThatAreStoredUpsideDown) {
    const std::string start = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    put(path("down.hdr"), start + "-Y 2 +X 1\n" + std::string(8, '\x7f'));
    read_picture(path("down.hdr"));
    put(path("up.hdr"), start + "+Y 2 +X 1\n" + std::string(8, '\x7f'));
    const auto [code, message] = refusal_of([&] { read_picture(path("up.hdr")); });
    EXPECT_EQ(code, ExitCode::input);
    EXPECT_NE(message.find("save it upright"), message.npos) << message;
}

TEST_F(ReadPicture, AHeaderHasSizeAndMetadata) {
    const PictureMetadata metadata{{"mirrorball:Note", "text"}};
    for (const char* name : {"a.png", "a.exr", "a.pfm", "a.tif", "a.jpg"}) {
        write_picture(path(name), ramp_picture(5, 3), Encoding::display, metadata);
        const PictureFile head = read_picture_header(path(name));
        EXPECT_TRUE(head.picture.pixels.empty()) << name;
        EXPECT_TRUE(have_same_shape(head.picture, read_picture(path(name)))) << name;
        EXPECT_EQ(head.metadata, read_picture_file(path(name)).metadata) << name;
    }
}

TEST_F(ReadPicture, PnmIsReadToo) {
    put(path("a.ppm"), std::string("P6\n2 1\n255\n\x00\x01\x02\xff\x80\x7f", 17));
    EXPECT_EQ(read_picture(path("a.ppm")).pixels,
              (std::vector<float>{0, 1 / 255.0f, 2 / 255.0f, 1, 128 / 255.0f, 127 / 255.0f}));
}

TEST_F(ReadPicture, PfmOfTheOtherByteOrderIsRead) {
    put(path("a.pfm"), std::string("Pf 2 1 1.0\n\x3f\x80\0\0\xc0\0\0\0", 19));
    EXPECT_EQ(read_picture(path("a.pfm")).pixels, (std::vector<float>{1.0f, -2.0f}));
}

TEST_F(ReadPicture, DamagedPfmHeadersAreRefused) {
    for (const char* header :
         {"PF\n", "PF\n1", "PF\n1 1\n0\n", "PF\n1 1\nnan\n", "PF\n1 1\ninf\n", "PF\n-1 1\n-1\n",
          "PF\n0 0\n-1\n", "PF\n99999 1\n-1\n", "PF\n65536 65536\n-1\n", "PF\n1x 1\n-1\n",
          "PFM\n1 1\n-1\n", "PF\n99999999999 1\n-1\n", "PF\n1 1\n-1\n01234567890",
          "PF\n1 1\n-1\n0123456789012", "PF\n1  1\n-1\n012345678901"}) {
        put(path("a.pfm"), header);
        EXPECT_EQ(refusal_of([&] { read_picture(path("a.pfm")); }).exit_code, ExitCode::input)
            << header;
    }
}

TEST_F(ReadPicture, HugeSizesAreRefusedBeforeMemoryIsTaken) {
    for (const char* size : {"65537 1", "1 65537", "65536 65536", "2147483647 2147483647"}) {
        put(path("a.ppm"), std::string("P6\n") + size + "\n255\nabc");
        EXPECT_EQ(refusal_of([&] { read_picture(path("a.ppm")); }).exit_code, ExitCode::input)
            << size;
    }
}

constexpr const char* all_formats[] = {"a.png", "a.exr", "a.pfm", "a.tif", "a.jpg", "a.webp",
                                       "a.hdr", "a.tga", "a.bmp", "a.ppm", "a.dpx"};

TEST_F(ReadPicture, TruncatedFilesAreRefusedOrWhole) {
    for (const std::string name : all_formats) {
        write_picture(path(name), ramp_picture(9, 20), Encoding::display,
                      PictureMetadata{{"mirrorball:Scene", "text"}});
        const std::string whole = contents(path(name));
        const Picture picture = read_picture(path(name));
        std::size_t accepted = 0;
        // OpenImageIO's readers are slower, and not ours.
        const std::size_t step = name == "a.png" || name == "a.exr" || name == "a.pfm" ? 1 : 13;
        for (std::size_t length = 0; length < whole.size(); length += step) {
            put(path("cut-" + name), whole.substr(0, length));
            const auto [code, message] = refusal_of([&] {
                EXPECT_EQ(bits(read_picture(path("cut-" + name))), bits(picture)) << length;
                ++accepted;
            });
            EXPECT_TRUE(code == ExitCode::done || code == ExitCode::input) << message;
        }
        // A PNG's end chunk holds no pixels, nor do the comments at a TGA file's end.
        EXPECT_LE(accepted, name == "a.tga" ? 521u : 16u) << name;
    }
}

TEST_F(ReadPicture, FlippedBytesNeverCrash) {
    std::mt19937 random(20240607);
    for (const std::string name : all_formats) {
        write_picture(path(name), ramp_picture(9, 20), Encoding::linear,
                      PictureMetadata{{"mirrorball:Scene", "text"}});
        const std::string whole = contents(path(name));
        const int rounds = name == "a.png" || name == "a.exr" || name == "a.pfm" ? 300 : 40;
        for (int round = 0; round < rounds; ++round) {
            std::string bytes = whole;
            const unsigned flips = 1 + random() % 3;
            for (unsigned i = 0; i < flips; ++i) {
                const std::size_t end = round % 2 == 0 ? bytes.size() : 400;  // headers too
                bytes[random() % std::min(end, bytes.size())] ^=
                    static_cast<char>(1 << random() % 8);
            }
            put(path("flipped-" + name), bytes);
            const auto [code, message] = refusal_of([&] { read_picture(path("flipped-" + name)); });
            EXPECT_TRUE(code == ExitCode::done || code == ExitCode::input) << message;
        }
    }
}

/// This process's peak memory since reset_peak, in bytes.
std::size_t peak() {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key;) {
        std::size_t kibibytes = 0;
        if (key == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
    }
    return 0;
}

void reset_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

/// Refused as input, in our own words, without allocating what the file promises.
void expect_cheap_refusal(const std::string& file, const std::string& reason) {
    refusal_of([&] { read_picture(file); });  // loads libraries
    reset_peak();
    const std::size_t before = peak();
    testing::internal::CaptureStderr();
    const auto [code, message] = refusal_of([&] { read_picture(file); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_LT(peak(), before + (std::size_t{100} << 20)) << message;
    EXPECT_EQ(code, ExitCode::input) << message;
    EXPECT_NE(message.find(reason), message.npos) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
}

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
    return bytes;
}

std::string png_chunk(const std::string& kind, const std::string& content) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : kind + content) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return big_endian(static_cast<std::uint32_t>(content.size())) + kind + content +
           big_endian(~crc);
}

std::string png_start(std::uint32_t width, std::uint32_t height, char interlaced = 0) {
    const std::string kind{8, 6, 0, 0, interlaced};  // RGBA of 8 bits
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian(width) + big_endian(height) + kind);
}

TEST_F(ReadPicture, PngThatPromisesTooMuchTakesNoMemory) {
    for (const char interlaced : {0, 1}) {
        put(path("a.png"), png_start(8192, 8192, interlaced) + png_chunk("IDAT", "x\x9c"));
        expect_cheap_refusal(path("a.png"), "cannot read");
    }
    put(path("a.png"), png_start(70000, 10) + png_chunk("IDAT", std::string(2000000, 'x')));
    expect_cheap_refusal(path("a.png"), "scale it down to at most");
    put(path("a.png"), png_start(0, 10) + png_chunk("IDAT", "x"));
    expect_cheap_refusal(path("a.png"), "cannot read");
    put(path("a.png"), png_start(10, 10) + png_chunk("IDAT", "no zlib"));
    expect_cheap_refusal(path("a.png"), "cannot read");
    put(path("a.png"), png_start(10, 10));
    expect_cheap_refusal(path("a.png"), "cannot read");
}

/// An EXR header with these attributes besides three half channels.
std::string exr_start(const std::string& more, char compression, char flags = 0) {
    const auto attribute = [](const std::string& name, const std::string& type,
                              const std::string& value) {
        const std::string size{static_cast<char>(value.size()), 0, 0, 0};
        return name + '\0' + type + '\0' + size + value;
    };
    const auto channel = [](char name) {
        return std::string{name, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    };
    const std::string none(4, '\0');
    return std::string{0x76, 0x2f, 0x31, 0x01, 2, flags, 0, 0} +
           attribute("channels", "chlist", channel('B') + channel('G') + channel('R') + '\0') +
           attribute("compression", "compression", {compression}) +
           attribute("displayWindow", "box2i", std::string(16, '\0')) +
           attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           attribute("pixelAspectRatio", "float", {0, 0, -128, 63}) +
           attribute("screenWindowCenter", "v2f", none + none) +
           attribute("screenWindowWidth", "float", {0, 0, -128, 63}) + more + '\0';
}

std::string exr_window(const std::string& last_x, const std::string& last_y) {
    return std::string("dataWindow\0box2i\0\x10\0\0\0", 21) + std::string(8, '\0') + last_x +
           last_y;
}

/// A TIFF file of one directory and no pixels; its entries are numbers of 32 bits.
std::string tiff(const std::vector<std::pair<int, std::uint32_t>>& entries) {
    const auto number = [](std::uint32_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i);
        return text;
    };
    std::string file = std::string("II*\0", 4) + number(8, 4) +
                       number(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& [tag, value] : entries) {
        file += number(static_cast<std::uint32_t>(tag), 2) + number(4, 2) + number(1, 4) +
                number(value, 4);
    }
    return file + number(0, 4);
}

TEST_F(ReadPicture, TiffThatPromisesTooMuchTakesNoMemory) {
    const int width = 256, height = 257, strip = 273, rows = 278, bytes = 279;
    const int tile_width = 322, tile_height = 323, tile = 324, tile_bytes = 325;
    put(path("strip.tif"), tiff({{width, 16384},
                                 {height, 16384},
                                 {258, 8},
                                 {259, 1},
                                 {262, 1},
                                 {strip, 8},
                                 {277, 1},
                                 {rows, 16384},
                                 {bytes, 1 << 28}}));
    expect_cheap_refusal(path("strip.tif"), "cannot read");
    put(path("tile.tif"), tiff({{width, 64},
                                {height, 64},
                                {258, 8},
                                {259, 1},
                                {262, 1},
                                {277, 1},
                                {tile_width, 1 << 16},
                                {tile_height, 1 << 14},
                                {tile, 8},
                                {tile_bytes, 1 << 30}}));
    expect_cheap_refusal(path("tile.tif"), "tiles");
}

TEST_F(ReadPicture, ExrThatPromisesTooMuchTakesNoMemory) {
    const std::string wide("\xff\xff\0\0", 4), narrow("\x0f\0\0\0", 4), half("\xff\x7f\0\0", 4),
        most("\xff\xff\xff\x7f", 4);
    const std::string tiles("tiles\0tiledesc\0\x09\0\0\0", 19);
    const char zip = 3, dwab = 9, tiled = 2;
    const std::string files[] = {
        exr_start(exr_window(wide, wide), zip),                  // more pixels than anything has
        exr_start(exr_window(most, most), zip),                  // sizes that overflow
        exr_start(exr_window(wide, std::string(4, '\0')), zip),  // one row, in no bytes
        exr_start(exr_window(wide, narrow), dwab),               // 256 rows as one
        exr_start(exr_window(narrow, narrow) + tiles + wide + wide + '\0', zip, tiled),
        exr_start(exr_window(narrow, narrow) + tiles + most + most + '\0', zip, tiled),
        exr_start(exr_window(wide, narrow) + tiles + std::string("\1\0\0\0\1\0\0\0\0", 9), zip,
                  tiled),
        exr_start(exr_window(half, half) + tiles + std::string("\1\0\0\0\1\0\0\0\0", 9), zip,
                  tiled),
        exr_start(exr_window(narrow, narrow), zip),  // no rows follow
        exr_start("", zip),
    };
    for (const std::string& file : files) {
        put(path("a.exr"), file);
        expect_cheap_refusal(path("a.exr"), "a.exr: ");
    }
}

// OpenEXR reads one of them, and the other's values would be missing; found by fuzzing.
TEST_F(ReadPicture, ExrThatSaysAThingTwiceIsRefused) {
    const std::string folder = std::string(MIRRORBALL_PICTURES_DIR) + "/";
    for (const char* name : {"channel-twice.exr", "two-sizes.exr"}) {
        expect_cheap_refusal(folder + name, "in part header");
    }
}

/// 11x7 pixels as other programs write them, and what OpenImageIO reads (22 Nov 2026).
TEST_F(ReadPicture, KindsOfPngAndExr) {
    const std::string folder = MIRRORBALL_PICTURES_DIR;
    const Picture none = read_picture(folder + "/none.exr");
    for (const char* name : {"zips", "rle", "piz", "pxr24", "tiles", "mipmap", "parts"}) {
        const Picture picture = read_picture(folder + "/" + name + ".exr");
        EXPECT_EQ(picture.width, 11) << name;
        EXPECT_EQ(bits(picture), bits(none)) << name;
    }
    EXPECT_EQ(none.pixels[4], 4 * 29 % 64 / 32.0f);
    const Picture palette = read_picture(folder + "/palette2.png");
    EXPECT_EQ(palette.channels, 4);
    EXPECT_EQ(palette.pixels[3], 0.0f);  // its first color is transparent
    const Picture wide = read_picture(folder + "/rgb16-interlaced.png");
    EXPECT_EQ(wide.pixels[1], (2 * 37 * 256 + 3 * 37) / 65535.0f);
    EXPECT_EQ(read_picture(folder + "/grey1.png").channels, 1);
    EXPECT_EQ(read_picture(folder + "/grey-alpha8.png").pixels[1], 37 / 255.0f);
    EXPECT_EQ(read_picture(folder + "/rgba8-interlaced.png").pixels[2], 74 / 255.0f);
}

}  // namespace
}  // namespace rt::this_file
