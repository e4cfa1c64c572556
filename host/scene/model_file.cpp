// SPDX-License-Identifier: Apache-2.0
#include "host/scene/model_file.h"

#include <fmt/format.h>

#include <string_view>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/mesh_finish.h"
#include "host/scene/obj_file.h"
#include "host/scene/ply_file.h"
#include "host/scene/text_file.h"

namespace rt {
namespace {

/// Opens libraries in the model's folder or beneath it.
OpenLibrary library_opener(const std::string& model_path, const std::filesystem::path& root) {
    const SceneFolder folder{root, std::filesystem::path(model_path).parent_path()};
    return [folder](const std::string& name) {
        const OpenedFile opened = open_beneath(folder, name);
        if (!opened.problem.empty()) return LibraryFile{{}, {}, opened.problem};
        const FileText text = read_text_file(opened.file, opened.path, max_model_bytes);
        return LibraryFile{opened.path, std::string(text.view()), {}};
    };
}

Model parse_model(const FileDescriptor& file, const std::string& path,
                  const ModelOptions& options) {
    const FileText text = read_text_file(file, path, max_model_bytes);
    if (is_ply_name(path)) return parse_ply(text.view(), printable(path));
    OpenLibrary open;
    if (options.with_materials) open = library_opener(path, options.root);
    return parse_obj(text.view(), printable(path), open);
}

}  // namespace

bool is_obj_name(const std::string& path) { return lower_extension(path) == ".obj"; }
bool is_ply_name(const std::string& path) { return lower_extension(path) == ".ply"; }

Model finish_model(Model model, const std::string& path, const Affine& transform) {
    const MeshLosses losses = finish_mesh(model.mesh, transform);
    if (losses.too_far) {
        throw Error(ExitCode::input, path +
                                         ": a vertex exceeds 1e30 after the transform; "
                                         "make the transform smaller");
    }
    if (model.mesh.faces.empty()) {
        throw Error(ExitCode::input, path +
                                         ": no face has any area, so there is nothing to draw; "
                                         "use a model with faces");
    }
    if (losses.zero_areas > 0) {
        model.notes.push_back(
            fmt::format("{}: ignored {}", path, counted(losses.zero_areas, "zero-area triangle")));
    }
    if (losses.zero_normals > 0) {
        model.notes.push_back(
            fmt::format("{}: {} of length 0, so faces there are flat", path,
                        counted(losses.zero_normals, "vertex normal is", "vertex normals are")));
    }
    return model;
}

Model load_model(const FileDescriptor& file, const std::string& path, const ModelOptions& options) {
    return finish_model(parse_model(file, path, options), printable(path), options.transform);
}

}  // namespace rt
