// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "host/file_descriptor.h"

namespace rt {

/// Where the files that a scene names may lie.
struct SceneFolder {
    std::filesystem::path root;  ///< nothing outside of it is read
    std::filesystem::path base;  ///< names are relative to it

    /// Of the scene in this file: both are the folder it lies in.
    static SceneFolder of(const std::string& scene_path);
};

/// An open file, or a problem.
struct OpenedFile {
    FileDescriptor file;
    std::string path;     ///< for messages
    std::string problem;  ///< "what is wrong; what to do"; empty when all is well
};

/// Opens the regular file that a scene calls `name`. Absolute names, "..", and symbolic links that
/// lead out of the folder are problems. What is open lies beneath the folder even if somebody
/// exchanges files and links meanwhile.
OpenedFile open_beneath(const SceneFolder& folder, const std::string& name);

}  // namespace rt
