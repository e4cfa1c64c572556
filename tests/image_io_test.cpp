// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <thread>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/oiio_loader.h"
#include "host/image/output_path.h"
#include "host/image/picture_format.h"
#include "host/image/picture_io.h"

namespace {

namespace fs = std::filesystem;
using rt::Encoding;
using rt::ExitCode;
using rt::Picture;

/// An empty directory of its own for each test.
class Scratch : public testing::Test {
   protected:
    Scratch() {
        std::string name = (fs::temp_directory_path() / "mirrorball-image-XXXXXX").string();
        directory_ = ::mkdtemp(name.data());
    }
    ~Scratch() override { fs::remove_all(directory_); }

    std::string path(const std::string& name) const { return (directory_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
    }

    fs::path directory_;
};

using WritePicture = Scratch;
using CheckPicturePath = Scratch;
using ReadPicture = Scratch;
using WriteFileAtomically = Scratch;
using PictureMetadata = Scratch;

std::string contents(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void put(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

void write_text(const std::string& path, const std::string& text) {
    rt::write_file_atomically(path, std::as_bytes(std::span(text)));
}

/// The exit code and message of the Error a call throws; done when it throws none.
template <typename Call>
std::pair<ExitCode, std::string> error_of(Call call) {
    try {
        call();
    } catch (const rt::Error& error) {
        return {error.exit_code(), error.what()};
    }
    return {ExitCode::done, ""};
}

std::vector<std::uint32_t> bits(const Picture& picture) {
    std::vector<std::uint32_t> result;
    for (const float value : picture.pixels) result.push_back(std::bit_cast<std::uint32_t>(value));
    return result;
}

/// Values a film may hold and 8 bits may not, no two rows alike.
Picture difficult_picture(int channels = 3) {
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

Picture ramp_picture(int width, int height) {
    Picture picture{width, height, 3, {}};
    for (int i = 0; i < width * height * 3; ++i) picture.pixels.push_back(i % 251 / 250.0f);
    return picture;
}

std::string text_of(const rt::PictureMetadata& metadata, const std::string& name) {
    for (const auto& [key, text] : metadata) {
        if (key == name) return text;
    }
    return "(none)";
}

TEST_F(WritePicture, FloatFilesKeepEveryBit) {
    for (const int channels : {1, 3}) {
        const Picture picture = difficult_picture(channels);
        for (const char* name : {"a.exr", "a.pfm"}) {
            rt::write_picture(path(name), picture, Encoding::srgb);
            const Picture back = rt::read_picture(path(name));
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
        rt::write_picture(path(name), picture, Encoding::display);
        EXPECT_EQ(bits(rt::read_picture(path(name))), bits(picture)) << name;
    }
}

TEST_F(WritePicture, PfmIsLittleEndianAndStartsAtTheBottom) {
    rt::write_picture(path("a.pfm"), {1, 2, 1, {1.0f, 2.0f}}, Encoding::display);
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
        rt::write_picture(path("a.png"), picture, encoding);
        const Picture back = rt::read_picture(path("a.png"));
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(back.pixels[i], static_cast<float>(expected[i]) / 255.0f) << i;
        }
    }
}

TEST_F(WritePicture, PngKeepsRowsAndChannelsInPlace) {
    Picture picture = ramp_picture(3, 2);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = i / 255.0f;
    rt::write_picture(path("a.png"), picture, Encoding::display);
    EXPECT_EQ(bits(rt::read_picture(path("a.png"))), bits(picture));
}

TEST_F(WritePicture, PngAlphaIsNeitherCurvedNorMultiplied) {
    const Picture picture{1, 1, 4, {1.0f, 0.5f, 0.0f, 0.5f}};
    rt::write_picture(path("a.png"), picture, Encoding::srgb);
    const Picture back = rt::read_picture(path("a.png"));
    EXPECT_EQ(back.pixels, (std::vector<float>{1.0f, 188 / 255.0f, 0.0f, 128 / 255.0f}));
}

TEST_F(WritePicture, SamePictureGivesTheSameBytes) {
    const rt::PictureMetadata metadata{{"mirrorball:Scene", "spheres"}, {"mirrorball:Rays", "7"}};
    const char* const names[] = {"a.png", "a.exr", "a.pfm"};
    for (const char* name : names) {
        rt::write_picture(path(name), ramp_picture(40, 30), Encoding::srgb, metadata);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (const std::string name : names) {
        const std::string other = path("b" + name.substr(1));
        rt::write_picture(other, ramp_picture(40, 30), Encoding::srgb, metadata);
        EXPECT_EQ(contents(path(name)), contents(other)) << name;
        const rt::PictureMetadata back = rt::read_picture_metadata(other);
        EXPECT_EQ(text_of(back, "DateTime"), "(none)");
        EXPECT_EQ(text_of(back, "Software"), "(none)");
    }
}

TEST_F(WritePicture, OnlyDeclaredEncodingsAreInTheFile) {
    const auto chunks = [&](Encoding encoding) {
        rt::write_picture(path("a.png"), ramp_picture(2, 2), encoding);
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

TEST_F(WritePicture, CapitalExtensionsAreTheSameFormats) {
    for (const char* name : {"A.PNG", "A.Exr", "A.PFM"}) {
        rt::write_picture(path(name), ramp_picture(2, 2), Encoding::display);
        EXPECT_EQ(rt::read_picture(path(name)).width, 2) << name;
    }
}

TEST_F(WritePicture, NamesWithSpacesAndUmlautsWork) {
    const std::string name = path("zwei B\xc3\xa4lle #1 %04d.exr");
    rt::write_picture(name, ramp_picture(2, 2), Encoding::display);
    EXPECT_EQ(rt::read_picture(name).width, 2);
}

TEST_F(WritePicture, OtherExtensionsAreWrongUsage) {
    for (const char* name : {"a.jpg", "a", "a.png.gz", ".png", "png"}) {
        const auto [code, message] =
            error_of([&] { rt::write_picture(path(name), ramp_picture(2, 2), Encoding::display); });
        EXPECT_EQ(code, ExitCode::usage) << name;
        EXPECT_NE(message.find(".png, .exr or .pfm"), message.npos) << message;
    }
    EXPECT_EQ(files(), 0u);
}

TEST_F(WritePicture, ImpossiblePicturesAndNamesAreOurBugs) {
    const auto code = [&](const Picture& picture, const std::string& name) {
        const rt::PictureMetadata metadata{{name, "text"}};
        return error_of(
                   [&] { rt::write_picture(path("a.exr"), picture, Encoding::display, metadata); })
            .first;
    };
    EXPECT_EQ(code(ramp_picture(2, 2), "mirrorball:Scene"), ExitCode::done);
    EXPECT_EQ(code({2, 2, 3, {1.0f}}, "mirrorball:Scene"), ExitCode::bug);
    EXPECT_EQ(code({0, 0, 3, {}}, "mirrorball:Scene"), ExitCode::bug);
    for (const char* name : {"DateTime", "mirrorball:", "mirrorball:a b", "mirrorball", "",
                             "mirrorball:TwentyOneLettersLong1"}) {
        EXPECT_EQ(code(ramp_picture(2, 2), name), ExitCode::bug) << name;
    }
}

TEST_F(WritePicture, FullDiskIsReportedAndTheOldFileStays) {
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    for (const char* name : {"a.png", "a.exr", "a.pfm"}) {
        rt::write_picture(path(name), ramp_picture(2, 2), Encoding::display);
        const std::string before = contents(path(name));
        rt::image_library(ExitCode::output);
        const rlimit small{100, old.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
        const auto [code, message] = error_of(
            [&] { rt::write_picture(path(name), ramp_picture(90, 90), Encoding::display); });
        ::setrlimit(RLIMIT_FSIZE, &old);
        EXPECT_EQ(code, ExitCode::output) << name;
        EXPECT_NE(message.find("cannot write: File too large; "), message.npos) << message;
        EXPECT_EQ(contents(path(name)), before) << name;
    }
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(files(), 3u);
}

TEST_F(PictureMetadata, SurvivesInPngAndExr) {
    const rt::PictureMetadata metadata{
        {"mirrorball:Options", "--size 64\nsecond line"},
        {"mirrorball:Scene", "Kugeln \xc3\xbc\xe2\x82\xac \"quoted\" <b>"},
        {"mirrorball:Settings", std::string(100000, 'x')},
        {"mirrorball:TwentyLettersAreFine", "1"},
        {"mirrorball:Empty", ""},
    };
    for (const char* name : {"a.png", "a.exr"}) {
        rt::write_picture(path(name), ramp_picture(4, 4), Encoding::display, metadata);
        const rt::PictureMetadata back = rt::read_picture_metadata(path(name));
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(text_of(back, metadata[i].first), metadata[i].second) << name;
        }
        EXPECT_EQ(text_of(back, "mirrorball:Empty"), "(none)");
    }
    rt::write_picture(path("a.pfm"), ramp_picture(4, 4), Encoding::display, metadata);
    EXPECT_TRUE(rt::read_picture_metadata(path("a.pfm")).empty());
}

TEST_F(CheckPicturePath, RefusesWhatCouldNotBeWritten) {
    const auto code = [&](const std::string& name) {
        return error_of([&] { rt::check_picture_path(name); }).first;
    };
    fs::create_directory(path("d.png"));
    put(path("file"), "");
    EXPECT_EQ(code(path("a.png")), ExitCode::done);
    const fs::path before = fs::current_path();
    fs::current_path(directory_);
    EXPECT_EQ(code("a.png"), ExitCode::done);
    fs::current_path(before);
    EXPECT_EQ(code(path("a.gif")), ExitCode::usage);
    EXPECT_EQ(code(""), ExitCode::usage);
    EXPECT_EQ(code(path("missing/a.png")), ExitCode::output);
    EXPECT_EQ(code(path("file/a.png")), ExitCode::output);
    EXPECT_EQ(code(path("d.png")), ExitCode::output);
    EXPECT_EQ(code(path("d.png/.exr")), ExitCode::usage);
    EXPECT_EQ(code(path(std::string(300, 'a') + ".png")), ExitCode::output);
    EXPECT_EQ(files(), 2u);
}

TEST_F(CheckPicturePath, RefusesReadOnlyPlaces) {
    if (::geteuid() == 0) GTEST_SKIP() << "root ignores permissions";
    put(path("a.png"), "");
    fs::permissions(path("a.png"), fs::perms::owner_read);
    EXPECT_EQ(error_of([&] { rt::check_picture_path(path("a.png")); }).first, ExitCode::output);
    fs::permissions(directory_, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(error_of([&] { rt::check_picture_path(path("b.png")); }).first, ExitCode::output);
    fs::permissions(directory_, fs::perms::owner_all);
}

TEST_F(WriteFileAtomically, NewFilesGetTheModeOfTheUmask) {
    const mode_t old = ::umask(0027);
    write_text(path("a"), "text");
    ::umask(old);
    EXPECT_EQ(contents(path("a")), "text");
    EXPECT_EQ(fs::status(path("a")).permissions(), static_cast<fs::perms>(0640));
    EXPECT_EQ(files(), 1u);
}

TEST_F(WriteFileAtomically, ExistingFilesKeepTheirMode) {
    put(path("a"), "a much longer old text");
    fs::permissions(path("a"), static_cast<fs::perms>(0604));
    write_text(path("a"), "new");
    EXPECT_EQ(contents(path("a")), "new");
    EXPECT_EQ(fs::status(path("a")).permissions(), static_cast<fs::perms>(0604));
}

TEST_F(WriteFileAtomically, SymlinksAreWrittenThrough) {
    fs::create_directory(path("d"));
    put(path("d/target"), "old");
    fs::create_symlink("d/target", path("link"));
    fs::create_symlink("link", path("second"));
    fs::create_symlink("d/not yet", path("dangling"));
    write_text(path("second"), "new");
    write_text(path("dangling"), "fresh");
    EXPECT_EQ(contents(path("d/target")), "new");
    EXPECT_EQ(contents(path("d/not yet")), "fresh");
    EXPECT_TRUE(fs::is_symlink(path("link")) && fs::is_symlink(path("second")));
    EXPECT_TRUE(fs::is_symlink(path("dangling")));
    fs::create_symlink("loop", path("loop"));
    EXPECT_EQ(error_of([&] { write_text(path("loop"), ""); }).first, ExitCode::output);
}

TEST_F(WriteFileAtomically, DevicesAndPipesAreNotReplaced) {
    fs::create_symlink("/dev/null", path("null"));
    write_text(path("null"), "text");
    write_text("/dev/null", "text");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));

    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = contents(path("pipe")); });
    write_text(path("pipe"), "through the pipe");
    reader.join();
    EXPECT_EQ(received, "through the pipe");
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(WriteFileAtomically, OpenFilesAreWrittenByTheirNumber) {
    std::FILE* file = std::fopen(path("a").c_str(), "w");
    std::fputs("before ", file);
    std::fflush(file);
    write_text("/proc/self/fd/" + std::to_string(::fileno(file)), "after");
    std::fclose(file);
    EXPECT_EQ(contents(path("a")), "before after");
}

TEST_F(WriteFileAtomically, FullDeviceIsReported) {
    const auto [code, message] = error_of([] { write_text("/dev/full", "text"); });
    EXPECT_EQ(code, ExitCode::output);
    EXPECT_EQ(message,
              "/dev/full: cannot write: No space left on device; "
              "free some space or write to another disk");
}

TEST_F(WriteFileAtomically, FailureLeavesTheDirectoryAsItWas) {
    for (const std::string& name : {path("missing/a"), path(""), path("new/"), std::string()}) {
        EXPECT_EQ(error_of([&] { write_text(name, "text"); }).first, ExitCode::output) << name;
    }
    EXPECT_EQ(files(), 0u);
}

TEST_F(WriteFileAtomically, ReadersSeeOneTextOrTheOther) {
    const std::string texts[] = {std::string(100000, 'a'), std::string(50000, 'b')};
    write_text(path("a"), texts[0]);
    std::thread writer([&] {
        for (int i = 0; i < 100; ++i) write_text(path("a"), texts[i % 2]);
    });
    for (int i = 0; i < 100; ++i) {
        const std::string seen = contents(path("a"));
        EXPECT_TRUE(seen == texts[0] || seen == texts[1]) << seen.size();
    }
    writer.join();
    EXPECT_EQ(files(), 1u);
}

TEST_F(ReadPicture, RefusesWhatIsNotAPicture) {
    ASSERT_EQ(::mkfifo(path("pipe.png").c_str(), 0600), 0);
    put(path("text.png"), "<html>not a picture</html>");
    put(path("empty.exr"), "");
    for (const std::string& name :
         {path("pipe.png"), directory_.string(), path("missing.png"), path("text.png"),
          path("empty.exr"), std::string("/dev/zero"), std::string()}) {
        const auto [code, message] = error_of([&] { rt::read_picture(name); });
        EXPECT_EQ(code, ExitCode::input) << name;
        EXPECT_EQ(message.find(name + ": "), 0u) << message;
        EXPECT_EQ(error_of([&] { rt::read_picture_metadata(name); }).first, ExitCode::input);
    }
}

TEST_F(ReadPicture, RefusesUnreadableFiles) {
    if (::geteuid() == 0) GTEST_SKIP() << "root ignores permissions";
    rt::write_picture(path("a.png"), ramp_picture(2, 2), Encoding::display);
    fs::permissions(path("a.png"), fs::perms::none);
    EXPECT_EQ(error_of([&] { rt::read_picture(path("a.png")); }).first, ExitCode::input);
}

TEST_F(ReadPicture, TheFirstBytesAndNotTheNameTellTheFormat) {
    rt::write_picture(path("a.exr"), difficult_picture(), Encoding::display);
    fs::rename(path("a.exr"), path("b.png"));
    EXPECT_EQ(bits(rt::read_picture(path("b.png"))), bits(difficult_picture()));
}

TEST_F(ReadPicture, PnmIsReadToo) {
    put(path("a.ppm"), std::string("P6\n2 1\n255\n\x00\x01\x02\xff\x80\x7f", 17));
    EXPECT_EQ(rt::read_picture(path("a.ppm")).pixels,
              (std::vector<float>{0, 1 / 255.0f, 2 / 255.0f, 1, 128 / 255.0f, 127 / 255.0f}));
}

TEST_F(ReadPicture, PfmOfTheOtherByteOrderIsRead) {
    put(path("a.pfm"), std::string("Pf 2 1 1.0\n\x3f\x80\0\0\xc0\0\0\0", 19));
    EXPECT_EQ(rt::read_picture(path("a.pfm")).pixels, (std::vector<float>{1.0f, -2.0f}));
}

TEST_F(ReadPicture, DamagedPfmHeadersAreRefused) {
    for (const char* header :
         {"PF\n", "PF\n1", "PF\n1 1\n0\n", "PF\n1 1\nnan\n", "PF\n1 1\ninf\n", "PF\n-1 1\n-1\n",
          "PF\n0 0\n-1\n", "PF\n99999 1\n-1\n", "PF\n65536 65536\n-1\n", "PF\n1x 1\n-1\n",
          "PFM\n1 1\n-1\n", "PF\n99999999999 1\n-1\n", "PF\n1 1\n-1\n01234567890",
          "PF\n1 1\n-1\n0123456789012", "PF\n1  1\n-1\n012345678901"}) {
        put(path("a.pfm"), header);
        EXPECT_EQ(error_of([&] { rt::read_picture(path("a.pfm")); }).first, ExitCode::input)
            << header;
    }
}

TEST_F(ReadPicture, HugeSizesAreRefusedBeforeMemoryIsTaken) {
    for (const char* size : {"65537 1", "1 65537", "65536 65536", "2147483647 2147483647"}) {
        put(path("a.ppm"), std::string("P6\n") + size + "\n255\nabc");
        EXPECT_EQ(error_of([&] { rt::read_picture(path("a.ppm")); }).first, ExitCode::input)
            << size;
    }
}

TEST_F(ReadPicture, TruncatedFilesAreRefusedOrWhole) {
    for (const std::string name : {"a.png", "a.exr", "a.pfm"}) {
        rt::write_picture(path(name), ramp_picture(9, 20), Encoding::display,
                          rt::PictureMetadata{{"mirrorball:Scene", "text"}});
        const std::string whole = contents(path(name));
        const Picture picture = rt::read_picture(path(name));
        std::size_t accepted = 0;
        for (std::size_t length = 0; length < whole.size(); ++length) {
            put(path("cut"), whole.substr(0, length));
            const auto [code, message] = error_of([&] {
                EXPECT_EQ(bits(rt::read_picture(path("cut"))), bits(picture)) << length;
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
        rt::write_picture(path(name), ramp_picture(9, 20), Encoding::linear,
                          rt::PictureMetadata{{"mirrorball:Scene", "text"}});
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
            const auto [code, message] = error_of([&] { rt::read_picture(path("flipped")); });
            EXPECT_TRUE(code == ExitCode::done || code == ExitCode::input) << message;
        }
    }
}

TEST(Encode8bit, FollowsTheStandardCurve) {
    // IEC 61966-2-1 evaluated with 50 digits (Python's decimal), then rounded.
    const std::pair<float, int> table[] = {
        {0.0f, 0},    {0.0001f, 0}, {0.001f, 3},  {0.0031308f, 10}, {0.0032f, 11}, {0.01f, 25},
        {0.05f, 63},  {0.1f, 89},   {0.18f, 118}, {0.2140f, 127},   {0.25f, 137},  {0.5f, 188},
        {0.75f, 225}, {0.9f, 243},  {0.99f, 254}, {0.999f, 255},    {1.0f, 255}};
    for (const auto& [value, expected] : table) {
        EXPECT_EQ(rt::encode_8bit(value, Encoding::srgb), expected) << value;
    }
    EXPECT_DOUBLE_EQ(rt::srgb_from_linear(1.0), 1.0);
}

TEST(Encode8bit, ClampsAndSendsNanToZero) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const Encoding encoding : {Encoding::display, Encoding::srgb, Encoding::linear}) {
        EXPECT_EQ(rt::encode_8bit(-1.0f, encoding), 0);
        EXPECT_EQ(rt::encode_8bit(-infinity, encoding), 0);
        EXPECT_EQ(rt::encode_8bit(std::nanf(""), encoding), 0);
        EXPECT_EQ(rt::encode_8bit(1.5f, encoding), 255);
        EXPECT_EQ(rt::encode_8bit(infinity, encoding), 255);
    }
}

TEST(ParseEncoding, IsTheInverseOfToString) {
    for (const Encoding encoding : {Encoding::display, Encoding::srgb, Encoding::linear}) {
        EXPECT_EQ(rt::parse_encoding(rt::to_string(encoding)), encoding);
    }
    EXPECT_EQ(error_of([] { rt::parse_encoding("sRGB"); }).first, ExitCode::usage);
}

TEST(ImageLibrary, MayBeCalledFromManyThreads) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([] { rt::image_library(ExitCode::output); });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(rt::image_library(ExitCode::output).version, rt::oiio::interface_version);
}

TEST(ImageLibrary, LoadsBesideOtherWork) {
    rt::ImageLibraryLoading loading;
    loading.begin_for("");
    loading.begin_for("picture.pfm");
    loading.begin_for("picture.png");
    loading.begin_for("picture.png");
    EXPECT_EQ(rt::image_library(ExitCode::output).version, rt::oiio::interface_version);
}

TEST(NeedsImageLibrary, AllButPfm) {
    EXPECT_TRUE(rt::needs_image_library(rt::picture_format_of_name("a.png")));
    EXPECT_TRUE(rt::needs_image_library(rt::picture_format_of_name("a.exr")));
    EXPECT_FALSE(rt::needs_image_library(rt::picture_format_of_name("a.pfm")));
}

}  // namespace
