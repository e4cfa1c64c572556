// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_meshes.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "host/scene/json_reader.h"
#include "host/scene/model_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::string_view mesh_keys[] = {"file", "material", "transform"};

std::optional<std::string> read_file_name(const JsonValue& value, std::string_view name,
                                          const SceneFolder& folder, Mistakes& mistakes) {
    const std::string* text = read_string(value, name, mistakes);
    if (!text) return std::nullopt;
    if (!is_obj_name(*text) && !is_ply_name(*text)) {
        mistakes.add(
            value.offset,
            fmt::format("{} is not a supported model file; name a file that ends in .obj or .ply",
                        in_quotes(*text)));
        return std::nullopt;
    }
    const OpenedFile opened = open_beneath(folder, *text);
    if (opened.problem.empty()) return *text;
    mistakes.add(value.offset, opened.problem);
    return std::nullopt;
}

/// Appends a model and its materials to the scene.
void add_model(Model model, const MeshRequest& request, Scene& scene) {
    const auto first = static_cast<int>(scene.materials.size());
    std::vector<int>& materials = model.mesh.face_materials;
    if (request.material) materials = {*request.material};
    if (!request.material) {
        for (int& material : materials) material += first;
        std::ranges::move(model.materials, std::back_inserter(scene.materials));
    }
    scene.meshes.push_back(std::move(model.mesh));
    std::ranges::move(model.notes, std::back_inserter(scene.notes));
    std::ranges::move(model.library_files, std::back_inserter(scene.model_files));
}

}  // namespace

MeshRequest read_mesh(const JsonValue& value, const MaterialTable& materials,
                      const SceneFolder& folder, Mistakes& mistakes) {
    MeshRequest request;
    request.offset = value.offset;
    const ObjectReader reader(value, "a mesh", mesh_keys, mistakes);
    reader.required("file", "\"file\": \"model.ply\"", request.file,
                    [&](const JsonValue& item, std::string_view name, Mistakes& noted) {
                        return read_file_name(item, name, folder, noted);
                    });
    const auto read_material = [&](const JsonValue& item, std::string_view name, Mistakes& noted) {
        return materials.read_reference(item, name, noted);
    };
    if (const JsonValue* material = reader.find("material")) {
        request.material = read_material(*material, "material", mistakes);
    } else if (is_ply_name(request.file)) {
        reader.require("material", "\"material\": \"name\": PLY files have none");
    }
    reader.optional("transform", request.transform, read_transform);
    return request;
}

void load_meshes(const std::vector<MeshRequest>& requests, const SceneFolder& folder, Scene& scene,
                 Mistakes& mistakes) {
    for (const MeshRequest& request : requests) {
        const OpenedFile opened = open_beneath(folder, request.file);
        if (!opened.problem.empty()) {
            mistakes.add(request.offset, opened.problem);
            continue;
        }
        const ModelOptions options{folder.root, !request.material, request.transform};
        Model model = load_model(opened.file, opened.path, options);
        if (!request.material && model.materials.empty()) {
            mistakes.add(request.offset, fmt::format("a mesh has no \"material\", and {} has none "
                                                     "either; add \"material\": \"name\"",
                                                     in_quotes(opened.path)));
            continue;
        }
        add_model(std::move(model), request, scene);
        scene.model_files.push_back(opened.path);
    }
}

}  // namespace rt
