// SPDX-License-Identifier: Apache-2.0
#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "host/base/parallel.h"
#include "host/base/version.h"
#include "host/print/print_stats.h"

namespace rt {

namespace {

#ifdef __clang__
constexpr const char* compiler = __VERSION__;  // "Debian Clang 14.0.6"
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

constexpr const char* unknown = "unknown";

/// The text after `separator` in the first line of the file that begins with `key`.
std::string value_in(const char* path, const std::string& key, const std::string& separator) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        const auto at = line.find(separator);
        if (line.rfind(key, 0) == 0 && at != std::string::npos) {
            return line.substr(at + separator.size());
        }
    }
    return unknown;
}

std::string os_name() {
    std::string name = value_in("/etc/os-release", "PRETTY_NAME", "=");
    std::erase(name, '"');
    return name;
}

std::string kernel_name() {
    utsname system{};
    if (uname(&system) != 0) return "unknown";
    return std::string(system.sysname) + " " + system.release + " " + system.machine;
}

/// null where the system does not report it.
Json memory_json() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_size <= 0) return nullptr;
    return static_cast<std::int64_t>(pages) * page_size;
}

/// The one-minute load average, in hundredths as the system reports it; null where it does not.
Json load_json() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? Json(std::round(load * 100) / 100) : Json(nullptr);
}

}  // namespace

std::string cpu_name() {
    const auto value = [](const char* key) { return value_in("/proc/cpuinfo", key, ": "); };
    const std::string family = value("cpu family"), model = value("model\t");
    std::string name = value("model name");
    if (family != unknown && model != unknown) {
        name += " (family " + family + ", model " + model + ")";
    }
    return name;
}

Json environment_json() {
    return {{"program", std::string("mirrorball ") + version},
            {"git_revision", git_revision},
            {"compiler", compiler},
            {"cpu", cpu_name()},
            {"cores", available_cores()},
            {"memory_bytes", memory_json()},
            {"os", os_name()},
            {"kernel", kernel_name()},
            {"load", load_json()}};
}

}  // namespace rt
