// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/gpu_nodes.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace rt {

namespace {

bool has_entry(const std::filesystem::path& folder, const char* prefix) {
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    return !error && std::any_of(begin(entry), end(entry), [&](const auto& file) {
        return file.path().filename().string().rfind(prefix, 0) == 0;
    });
}

}  // namespace

bool gpu_may_be_here(const std::string& folder) {
    const std::filesystem::path dev(folder);
    constexpr std::array prefixes{"nvidia", "kfd", "dxg", "mali", "pvr"};
    const auto is_here = [&](const char* prefix) { return has_entry(dev, prefix); };
    return std::any_of(prefixes.begin(), prefixes.end(), is_here) ||
           has_entry(dev / "dri", "renderD") || has_entry(dev / "accel", "accel");
}

}  // namespace rt
