// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "host/base/text.h"
#include "host/scene/line_scanner.h"
#include "host/scene/mtl_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Reads libraries into a model: each file once, and the first material of each name.
class Libraries {
   public:
    explicit Libraries(const OpenLibrary& open) : open_(open) {}

    /// Adds what one mtllib statement names: one file, if there is one of that name (names may hold
    /// blanks), else one per word. Returns the problem, if any.
    std::string add_all(const std::string& names) {
        std::string problem = add(names);
        if (problem.empty() || names.find_first_of(" \t") == names.npos) return problem;
        LineScanner words(names);
        for (problem.clear(); problem.empty() && words.word_follows();) {
            problem = add(std::string(words.word()));
        }
        return problem;
    }

    Model take() { return std::move(model_); }

   private:
    std::string add(const std::string& name) {
        if (files_.contains(name)) return {};
        const LibraryFile file = open_(name);
        if (!file.problem.empty()) return file.problem;
        files_.insert(name);
        model_.library_files.push_back(file.path);
        MtlLibrary library = parse_mtl(file.text, printable(file.path));
        for (Scene::Material& material : library.materials) {
            if (!known_.insert(material.name).second) continue;
            model_.materials.push_back(std::move(material));
        }
        std::ranges::move(library.notes, std::back_inserter(model_.notes));
        return {};
    }

    const OpenLibrary& open_;
    Model model_;
    std::unordered_set<std::string> files_, known_;
};

}  // namespace

int ObjMaterials::use(const ObjMaterialUse& use) {
    if (use.name.empty()) return -1;
    const auto [found, is_new] = numbers_.emplace(use.name, static_cast<int>(used_.size()));
    if (is_new) used_.push_back(use);
    return found->second;
}

Model ObjMaterials::load(const OpenLibrary& open, const Mistakes& mistakes) {
    Libraries libraries(open);
    std::vector<std::string> notes;
    for (const ObjLibraryUse& statement : libraries_) {
        const std::string problem = libraries.add_all(statement.names);
        if (problem.empty()) continue;
        lacks_library_ = true;
        notes.push_back(fmt::format("{}: {}; until then its materials are gray",
                                    mistakes.place(statement.offset), problem));
    }
    Model model = libraries.take();
    model.notes.insert(model.notes.begin(), notes.begin(), notes.end());
    return model;
}

void ObjMaterials::resolve(Model& model, Mistakes& mistakes) const {
    std::unordered_map<std::string_view, int> known;
    std::vector<std::string_view> names;
    for (const Scene::Material& material : model.materials) {
        known.emplace(material.name, static_cast<int>(known.size()));
        names.push_back(material.name);
    }
    const auto fallback = static_cast<int>(model.materials.size());
    std::vector<int> indices;
    for (const ObjMaterialUse& use : used_) {
        const auto found = known.find(use.name);
        indices.push_back(found == known.end() ? fallback : found->second);
        if (found != known.end() || lacks_library_) continue;
        mistakes.add(use.offset, fmt::format("unknown material {}; {}", in_quotes(use.name),
                                             suggestion(use.name, names, "the libraries contain")));
    }
    const auto index_of = [&](int number) {
        return number < 0 ? fallback : indices[static_cast<std::size_t>(number)];
    };
    std::ranges::transform(model.mesh.face_materials, model.mesh.face_materials.begin(), index_of);
    if (std::ranges::find(model.mesh.face_materials, fallback) != model.mesh.face_materials.end()) {
        model.materials.push_back(default_material());
    }
}

Scene::Material default_material() {
    Scene::Material material;
    material.name = "default";
    material.ambient = material.diffuse = glm::dvec3(0.7);
    material.two_sided = true;
    return material;
}

}  // namespace rt
