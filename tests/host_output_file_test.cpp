// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "host/image/output_file.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;
using WriteFileAtomically = ScratchFolder;

void write_text(const std::string& path, const std::string& text) {
    write_file_atomically(path, std::as_bytes(std::span(text)));
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
    EXPECT_EQ(refusal_of([&] { write_text(path("loop"), ""); }).exit_code, ExitCode::output);
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
    const auto [code, message] = refusal_of([] { write_text("/dev/full", "text"); });
    EXPECT_EQ(code, ExitCode::output);
    EXPECT_EQ(message,
              "/dev/full: cannot write: No space left on device; "
              "free some space or write to another disk");
}

TEST_F(WriteFileAtomically, FailureLeavesTheDirectoryAsItWas) {
    for (const std::string& name : {path("missing/a"), path(""), path("new/"), std::string()}) {
        EXPECT_EQ(refusal_of([&] { write_text(name, "text"); }).exit_code, ExitCode::output)
            << name;
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

TEST_F(WriteFileAtomically, AKilledWriterLeavesNothing) {
    const int unnamed = ::open(directory_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (unnamed < 0) GTEST_SKIP() << "this file system must name temporary files";
    ::close(unnamed);
    put(path("a"), "old");
    const pid_t child = ::fork();
    if (child == 0) {
        AtomicFile file(path("a"));
        file.write(std::as_bytes(std::span(std::string_view("half"))));
        ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(contents(path("a")), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(WriteFileAtomically, UncommittedFilesLeaveNothing) {
    put(path("a"), "old");
    {
        AtomicFile file(path("a"));
        file.write(std::as_bytes(std::span(std::string_view("new"))));
    }
    EXPECT_EQ(contents(path("a")), "old");
    EXPECT_EQ(files(), 1u);
}

using OutputPath = ScratchFolder;

TEST_F(OutputPath, PartialComesBeforeTheEnding) {
    EXPECT_EQ(partial_path("out.png"), "out.partial.png");
    EXPECT_EQ(partial_path("/a.b/out.0001.exr"), "/a.b/out.0001.partial.exr");
    EXPECT_EQ(partial_path("a.b/out"), "a.b/out.partial");
    const std::string longest = "d/" + std::string(251, 'a') + ".png";
    EXPECT_EQ(partial_path(longest), "d/" + std::string(243, 'a') + ".partial.png");
}

TEST_F(OutputPath, OutputsThatAreInputsAreRefused) {
    put(path("scene.json"), "");
    put(path("other.png"), "");
    fs::create_symlink("scene.json", path("symbolic.png"));
    fs::create_hard_link(path("scene.json"), path("hard.png"));
    const UsedFiles inputs({path("missing"), "", path("scene.json")});
    for (const char* name : {"scene.json", "symbolic.png", "hard.png"}) {
        const auto [code, message] = refusal_of([&] { inputs.check(path(name)); });
        EXPECT_EQ(code, ExitCode::usage) << name;
        EXPECT_EQ(message, path(name) + ": is the same file as " + path("scene.json") +
                               "; choose another output");
    }
    for (const std::string& name : {path("other.png"), path("new.png"), std::string("-"),
                                    std::string(), std::string("/dev/null")}) {
        inputs.check(name);
        UsedFiles({"/dev/null"}).check(name);
    }
}

}  // namespace
}  // namespace rt::this_file
