// SPDX-License-Identifier: Apache-2.0
#include "host/scene/beneath.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "host/scene/words.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

/// "" is the working folder, which canonical() does not know.
fs::path folder_or_here(const fs::path& folder) { return folder.empty() ? "." : folder; }

bool climbs(const fs::path& name) {
    return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

bool lies_in(const fs::path& file, const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

}  // namespace

SceneFolder SceneFolder::of(const std::string& scene_path) {
    const fs::path folder = fs::path(scene_path).parent_path();
    return {folder, folder};
}

FoundFile find_beneath(const SceneFolder& folder, const std::string& name) {
    const auto problem = [&](std::string_view what) {
        return FoundFile{{}, fmt::format("{} {}", in_quotes(name), what)};
    };
    constexpr std::string_view outside =
        "lies outside of the scene's folder; put it beside the scene, or in a folder there";
    if (name.empty()) return problem("names no file; write the name of one");
    if (climbs(name)) return problem(outside);
    const fs::path path = folder.base / name;
    std::error_code error;
    const fs::path real = name.find('\0') == name.npos ? fs::canonical(path, error) : fs::path();
    if (error || real.empty()) return problem("is no file that can be reached; check the name");
    const fs::path root = fs::canonical(folder_or_here(folder.root), error);
    if (error || !lies_in(real, root)) return problem(outside);
    if (!fs::is_regular_file(real, error)) return problem("is not a regular file; name one");
    return {path.string(), {}};
}

}  // namespace rt
