// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "host/image/picture_io.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt {
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
        EXPECT_EQ(refusal_of([&] { read_picture_metadata(name); }).exit_code, ExitCode::input);
    }
}

TEST_F(ReadPicture, RefusesUnreadableFiles) {
    if (::geteuid() == 0) GTEST_SKIP() << "root ignores permissions";
    write_picture(path("a.png"), ramp_picture(2, 2), Encoding::display);
    fs::permissions(path("a.png"), fs::perms::none);
    EXPECT_EQ(refusal_of([&] { read_picture(path("a.png")); }).exit_code, ExitCode::input);
}

TEST_F(ReadPicture, TheFirstBytesAndNotTheNameTellTheFormat) {
    write_picture(path("a.exr"), difficult_picture(), Encoding::display);
    fs::rename(path("a.exr"), path("b.png"));
    EXPECT_EQ(bits(read_picture(path("b.png"))), bits(difficult_picture()));
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

TEST_F(ReadPicture, TruncatedFilesAreRefusedOrWhole) {
    for (const std::string name : {"a.png", "a.exr", "a.pfm"}) {
        write_picture(path(name), ramp_picture(9, 20), Encoding::display,
                      PictureMetadata{{"mirrorball:Scene", "text"}});
        const std::string whole = contents(path(name));
        const Picture picture = read_picture(path(name));
        std::size_t accepted = 0;
        for (std::size_t length = 0; length < whole.size(); ++length) {
            put(path("cut"), whole.substr(0, length));
            const auto [code, message] = refusal_of([&] {
                EXPECT_EQ(bits(read_picture(path("cut"))), bits(picture)) << length;
                ++accepted;
            });
            EXPECT_TRUE(code == ExitCode::done || code == ExitCode::input) << message;
        }
        EXPECT_LE(accepted, 16u) << name;  // the end mark of a PNG tells nothing about its pixels
    }
}

TEST_F(ReadPicture, FlippedBytesNeverCrash) {
    std::mt19937 random(20240607);
    for (const std::string name : {"a.png", "a.exr", "a.pfm"}) {
        write_picture(path(name), ramp_picture(9, 20), Encoding::linear,
                      PictureMetadata{{"mirrorball:Scene", "text"}});
        const std::string whole = contents(path(name));
        for (int round = 0; round < 300; ++round) {
            std::string bytes = whole;
            const unsigned flips = 1 + random() % 3;
            for (unsigned i = 0; i < flips; ++i) {
                const std::size_t end = round % 2 == 0 ? bytes.size() : 400;  // headers too
                bytes[random() % std::min(end, bytes.size())] ^=
                    static_cast<char>(1 << random() % 8);
            }
            put(path("flipped"), bytes);
            const auto [code, message] = refusal_of([&] { read_picture(path("flipped")); });
            EXPECT_TRUE(code == ExitCode::done || code == ExitCode::input) << message;
        }
    }
}

}  // namespace
}  // namespace rt
