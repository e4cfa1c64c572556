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

/// By a file's name, letter case aside.
bool is_obj_name(const std::string& path);
bool is_ply_name(const std::string& path);

struct ModelOptions {
    std::filesystem::path root;  ///< material libraries outside of it are not read
    bool with_materials = true;  ///< read the libraries that the model names
    Affine transform;            ///< not singular
};

/// Reads an OBJ or PLY file that is open: a mesh as scenes have it, but for its materials, which
/// count from the model's own. Throws Error: ExitCode::input for a file that is wrong or holds
/// nothing to draw, ExitCode::limit for one that is too large.
Model load_model(const FileDescriptor& file, const std::string& path, const ModelOptions& options);

/// The same for what a file holds.
Model finish_model(Model model, const std::string& path, const Affine& transform);

/// A model alone: in the middle of a picture, from the right, the front and a little above, on a
/// light ground with two lights (docs/scene-format.md).
Scene load_model_scene(const std::string& path);
Scene make_model_scene(Model model, const std::string& path);

}  // namespace rt
