// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "host/scene/affine.h"
#include "host/scene/beneath.h"
#include "host/scene/model.h"

namespace rt {

inline constexpr std::size_t max_model_bytes = std::size_t{2} << 30;

/// Decides by the file extension, ignoring case.
bool is_obj_name(const std::string& path);
bool is_ply_name(const std::string& path);

struct ModelOptions {
    std::filesystem::path root;  ///< material libraries outside of it are not read
    bool with_materials = true;  ///< read the libraries that the model names
    Affine transform;            ///< not singular
};

/// Reads an open OBJ or PLY file: a mesh ready for a scene, except that its material indices refer
/// to the model's own. Throws Error: ExitCode::input for a file that is wrong or has nothing to
/// draw, ExitCode::limit for one that is too large.
Model load_model(const FileDescriptor& file, const std::string& path, const ModelOptions& options);

/// The last step of load_model, for a parsed model.
Model finish_model(Model model, const std::string& path, const Affine& transform);

/// A scene of one model: centered, seen from the right, the front and slightly above, on a light
/// background with two lights (docs/scene-format.md).
Scene load_model_scene(const std::string& path);
Scene make_model_scene(Model model, const std::string& path);

}  // namespace rt
