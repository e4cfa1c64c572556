// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace rt {

/// Where the files that a scene names may lie.
struct SceneFolder {
    std::filesystem::path root;  ///< nothing outside of it is read
    std::filesystem::path base;  ///< names are relative to it

    /// Of the scene in this file: both are the folder it lies in.
    static SceneFolder of(const std::string& scene_path);
};

/// One of path and problem is empty.
struct FoundFile {
    std::string path;
    std::string problem;  ///< "what is wrong; what to do"
};

/// The regular file that a scene calls `name`. Absolute names, "..", and symbolic links that lead
/// out of the folder are problems.
FoundFile find_beneath(const SceneFolder& folder, const std::string& name);

}  // namespace rt
