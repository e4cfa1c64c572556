// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/geometry.h"
#include "host/scene/line_scanner.h"
#include "host/scene/scene.h"
#include "host/scene/text_file.h"

namespace rt {

/// What a model file holds, in its own coordinates. A reader has checked that indices are good
/// and numbers finite; finish_mesh sees to the rest.
struct Model {
    Scene::Mesh mesh;  ///< face_materials: indices into materials, or a single -1 if there are none
    std::vector<Scene::Material> materials;
    std::vector<std::string> notes;  ///< what was left out, a sentence each
    std::vector<std::string> library_files;
};

/// A material library referenced by an OBJ: its text, or why it could not be read.
struct LibraryFile {
    std::string path;  ///< as opened
    std::string text;
    std::string problem;  ///< "what is wrong; what to do"
};

using OpenLibrary = std::function<LibraryFile(const std::string& name)>;

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

/// A scene of one model: centered, seen from the right, the front and slightly above, on a light
/// background with two lights (docs/scene-format.md).
Scene load_model_scene(const std::string& path);
Scene make_model_scene(Model model, const std::string& path);

/// Reads a Wavefront OBJ (1992): v, vn and f make the mesh; docs/scene-format.md lists the other
/// statements. `open` opens material libraries; without it materials are ignored. Faces that cannot
/// be built are left out with a note; throws Error, ExitCode::input, if none is left.
Model parse_obj(std::string_view text, const std::string& file_name, const OpenLibrary& open,
                const ReadPace& pace = {});

/// Reads a PLY model (Turk 1994): ascii or binary of either byte order. Elements 'vertex' (x, y,
/// z, and nx, ny, nz), 'face' (vertex_indices or vertex_index) and 'tristrips' make the mesh;
/// others are skipped. Faces that cannot be built are left out with a note. Throws Error,
/// ExitCode::input, if none is left, or if the header or missing bytes leave the mesh unknown.
Model parse_ply(std::string_view text, const std::string& file_name, const ReadPace& pace = {});

}  // namespace rt
