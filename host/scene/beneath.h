// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "host/base/files.h"

namespace rt {

/// Where the files that a scene refers to may be.
struct SceneFolder {
    std::filesystem::path root;  ///< nothing outside of it is read
    std::filesystem::path base;  ///< names are relative to it

    /// For the scene in this file: both are the folder that contains it.
    static SceneFolder of(const std::string& scene_path);
};

/// An open file, or why it could not be opened.
struct OpenedFile {
    FileDescriptor file;
    std::string path;     ///< for messages
    std::string problem;  ///< "what is wrong; what to do"; empty on success
};

/// Opens the regular file that a scene calls `name`. Refuses absolute names, "..", and symbolic
/// links that lead out of the folder. The opened file lies beneath the folder even if files and
/// links are replaced meanwhile. Throws Error (ExitCode::limit) if the system allows no more files.
OpenedFile open_beneath(const SceneFolder& folder, const std::string& name);

}  // namespace rt
