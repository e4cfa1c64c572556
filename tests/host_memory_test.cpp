// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "host/base/memory.h"
#include "host/render/film.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t mib = 1 << 20;

/// A fake file system, with the files that report free memory.
class FreeMemoryTest : public ScratchFolder {
   protected:
    FreeMemoryTest() {
        write("proc/meminfo", "MemTotal: 8388608 kB\nMemAvailable:  4194304 kB\nBuffers: 1 kB\n");
        write("proc/self/statm", "100 10 10 1 0 1 0\n");
    }

    void write(const std::string& name, const std::string& text) {
        fs::create_directories(fs::path(path(name)).parent_path());
        put(path(name), text);
    }

    void group(const std::string& name, const std::string& limit, std::uint64_t usage,
               std::uint64_t cache) {
        write(name + "/memory.max", limit + "\n");
        write(name + "/memory.current", std::to_string(usage) + "\n");
        write(name + "/memory.stat", "anon 1\ninactive_file " + std::to_string(cache) + "\n");
    }

    FreeMemory free() const { return free_memory(directory_.string()); }
};

TEST_F(FreeMemoryTest, IsWhatTheMachineHas) {
    EXPECT_EQ(free().bytes, 4096 * mib);
    EXPECT_EQ(free().reason, "are free");
}

TEST_F(FreeMemoryTest, IsWhatTheContainerLeaves) {
    write("proc/self/cgroup", "0::/\n");
    group("sys/fs/cgroup", std::to_string(512 * mib), 200 * mib, 100 * mib);
    EXPECT_EQ(free().bytes, 412 * mib);
    EXPECT_NE(free().reason.find("cgroup"), std::string::npos);
    group("sys/fs/cgroup", std::to_string(100 * mib), 200 * mib, 50 * mib);
    EXPECT_EQ(free().bytes, 0u);
    group("sys/fs/cgroup", "max", 200 * mib, 0);
    EXPECT_EQ(free().bytes, 4096 * mib);
}

TEST_F(FreeMemoryTest, IsWhatTheTightestGroupLeaves) {
    write("proc/self/cgroup", "0::/jobs/job 7/step\n");
    group("sys/fs/cgroup/jobs", std::to_string(900 * mib), 300 * mib, 0);
    group("sys/fs/cgroup/jobs/job 7", std::to_string(500 * mib), 100 * mib, 0);
    group("sys/fs/cgroup/jobs/job 7/step", "max", 100 * mib, 0);
    EXPECT_EQ(free().bytes, 400 * mib);
}

TEST_F(FreeMemoryTest, IsUnlimitedWhereNothingTells) {
    EXPECT_EQ(free_memory("/nowhere").bytes, std::numeric_limits<std::uint64_t>::max());
}

TEST(CheckMemory, NamesTheBufferItsBytesAndTheWayOut) {
    check_memory(1, "a pixel", "nothing");
    const auto [code, message] =
        refusal_of([] { check_memory(std::uint64_t{1} << 60, "the film", "use --crop"); });
    EXPECT_EQ(code, ExitCode::limit);
    EXPECT_EQ(message.find("the film needs 1099511627776 MiB of memory, but only "), 0u) << message;
    EXPECT_NE(message.find("; use --crop"), message.npos) << message;
}

/// The flags of this process's mapping that holds an address.
std::string flags_at(const void* address) {
    std::ifstream maps("/proc/self/smaps");
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    bool inside = false;
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t first = 0, end = 0;
        char dash = 0;
        std::istringstream range(line);
        if (range >> std::hex >> first >> dash >> end && dash == '-') {
            inside = first <= wanted && wanted < end;
        }
        if (inside && line.starts_with("VmFlags:")) return line + " ";
    }
    return "";
}

TEST(Film, BeginsBlackOnLargePagesWhereThereIsMuch) {
    const std::vector<float> items = Film<float>(1024, 1024).rgb;
    EXPECT_EQ(items.size(), 3 * mib);
    EXPECT_EQ(std::count(items.begin(), items.end(), 0.0f), static_cast<std::ptrdiff_t>(3 * mib));
    if (!fs::exists("/sys/kernel/mm/transparent_hugepage")) GTEST_SKIP() << "no large pages here";
    const std::string flags = flags_at(&items[mib]);
    EXPECT_NE(flags.find(" hg "), flags.npos) << flags;
}

}  // namespace
}  // namespace rt::this_file
