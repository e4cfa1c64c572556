// SPDX-License-Identifier: Apache-2.0
#include "host/memory_limit.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "host/error.h"

namespace rt {

namespace {

/// MemAvailable of /proc/meminfo in bytes; no limit where the system does not tell.
std::uint64_t available_bytes() {
    std::ifstream file("/proc/meminfo");
    for (std::string key, unit; file >> key;) {
        std::uint64_t kibibytes = 0;
        file >> kibibytes;
        std::getline(file, unit);
        if (key == "MemAvailable:") return kibibytes * 1024;
    }
    return std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice) {
    const std::uint64_t available = available_bytes();
    if (bytes <= available) return;
    constexpr double gib = 1 << 30;
    throw Error(ExitCode::limit,
                fmt::format("{} needs {:.1f} GiB of memory and {:.1f} GiB are free; {}", what,
                            static_cast<double>(bytes) / gib, static_cast<double>(available) / gib,
                            advice));
}

}  // namespace rt
