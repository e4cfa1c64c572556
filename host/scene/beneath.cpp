// SPDX-License-Identifier: Apache-2.0
#include "host/scene/beneath.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "host/base/error.h"
#include "host/scene/words.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

/// "" means the working folder, which canonical() does not accept.
fs::path folder_or_here(const fs::path& folder) { return folder.empty() ? "." : folder; }

bool climbs(const fs::path& name) {
    return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

bool lies_in(const fs::path& file, const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

/// Opens a path of plain names component by component, following no links: like openat2 with
/// RESOLVE_BENEATH and RESOLVE_NO_SYMLINKS, but on any kernel. None on failure.
FileDescriptor open_steps(const fs::path& root, const fs::path& steps) {
    constexpr int flags = O_RDONLY | O_NOFOLLOW | O_CLOEXEC;
    FileDescriptor at(open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (auto step = steps.begin(); at && step != steps.end(); ++step) {
        const bool last = std::next(step) == steps.end();
        const int kind = last ? O_NONBLOCK | O_NOCTTY : O_PATH | O_DIRECTORY;
        at = FileDescriptor(openat(at.number(), step->c_str(), flags | kind));
    }
    return at;
}

bool is_regular(const FileDescriptor& file) {
    struct stat status {};
    return fstat(file.number(), &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

SceneFolder SceneFolder::of(const std::string& scene_path) {
    const fs::path folder = fs::path(scene_path).parent_path();
    return {folder, folder};
}

OpenedFile open_beneath(const SceneFolder& folder, const std::string& name) {
    const auto problem = [&](std::string_view what) {
        return OpenedFile{FileDescriptor(), {}, fmt::format("{} {}", in_quotes(name), what)};
    };
    constexpr std::string_view outside = "is outside the scene's folder; move it into that folder";
    const std::string unreachable = fmt::format("cannot be found or opened in {}; check the name",
                                                in_quotes(folder_or_here(folder.base).string()));
    if (name.empty()) return problem("is not a file name; write one");
    if (climbs(name)) return problem(outside);
    const fs::path path = folder.base / name;
    std::error_code error;
    const fs::path real = name.find('\0') == name.npos ? fs::canonical(path, error) : fs::path();
    if (error || real.empty()) return problem(unreachable);
    const fs::path root = fs::canonical(folder_or_here(folder.root), error);
    if (error || !lies_in(real, root)) return problem(outside);
    FileDescriptor file = open_steps(root, real.lexically_relative(root));
    if (!file && errno == EACCES) return problem("cannot be read; check its permissions");
    if (!file && (errno == ENOENT || errno == ENOTDIR || errno == ELOOP || errno == ENXIO)) {
        return problem(unreachable);
    }
    if (!file) {
        throw Error(ExitCode::limit, fmt::format("{}: cannot be opened: {}; raise the limit",
                                                 in_quotes(name), std::strerror(errno)));
    }
    if (!is_regular(file)) return problem("is not a regular file; name one");
    return {std::move(file), path.string(), {}};
}

}  // namespace rt
