// SPDX-License-Identifier: Apache-2.0
#include "host/base/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "host/base/error.h"

namespace rt {

void advise_huge_pages(void* memory, std::size_t bytes) {
    constexpr std::size_t worthwhile = std::size_t{4} << 20;
    if (bytes < worthwhile) return;
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto start = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (start + page - 1) / page * page;
    const std::uintptr_t end = (start + bytes) / page * page;
    madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

void take_least(FreeMemory& least, std::uint64_t bytes, const char* reason) {
    if (bytes < least.bytes) least = {bytes, reason};
}

/// The number after a key, as in "MemAvailable: 123 kB" or "inactive_file 123".
std::optional<std::uint64_t> number_of(const fs::path& path, const std::string& key) {
    std::ifstream file(path);
    for (std::string word, rest; file >> word; std::getline(file, rest)) {
        std::uint64_t number = 0;
        if (word == key && file >> number) return number;
    }
    return std::nullopt;
}

/// Reads a file that holds one number; empty for anything else, such as "max".
std::optional<std::uint64_t> number_in(const fs::path& path) {
    std::ifstream file(path);
    std::uint64_t number = 0;
    if (file >> number) return number;
    return std::nullopt;
}

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) {
    return limit > used ? limit - used : 0;
}

void take_group(FreeMemory& least, const fs::path& group) {
    const auto limit = number_in(group / "memory.max");
    const auto usage = number_in(group / "memory.current");
    if (!limit || !usage) return;
    // The system reclaims file caches first.
    const std::uint64_t cache = number_of(group / "memory.stat", "inactive_file").value_or(0);
    take_least(least, difference(*limit, difference(*usage, cache)),
               "remain within the memory limit of the container or job (cgroup)");
}

/// Visits this process's group and its ancestors. In a container the path may be the host's, with
/// the container's own group mounted at the top.
void take_groups(FreeMemory& least, const fs::path& root) {
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("0::")) continue;  // version 1
        const fs::path mount = root / "sys/fs/cgroup";
        fs::path group = fs::path(line.substr(3)).relative_path();
        for (; !group.empty(); group = group.parent_path()) take_group(least, mount / group);
        take_group(least, mount);
    }
}

void take_address_space(FreeMemory& least, const std::string& root) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    const auto pages = number_in(root + "/proc/self/statm").value_or(0);
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    take_least(least, difference(limit.rlim_cur, pages * page),
               "remain of its address space (ulimit -v)");
}

}  // namespace

FreeMemory free_memory(const std::string& root) {
    FreeMemory least{unlimited, "are free"};
    if (const auto kibibytes = number_of(root + "/proc/meminfo", "MemAvailable:")) {
        take_least(least, *kibibytes * 1024, "are free");
    }
    take_groups(least, root.empty() ? "/" : root);
    take_address_space(least, root);
    return least;
}

void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice) {
    constexpr std::uint64_t trifle = 1 << 20;
    if (bytes < trifle) return;
    const FreeMemory free = free_memory();
    if (bytes <= free.bytes) return;
    const auto mib = [](std::uint64_t count) { return static_cast<double>(count) / (1 << 20); };
    throw Error(ExitCode::limit,
                fmt::format("{} needs {:.0f} MiB of memory, but only {:.0f} MiB {}; {}", what,
                            mib(bytes), mib(free.bytes), free.reason, advice));
}

}  // namespace rt
