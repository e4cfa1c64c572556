// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "host/scene/mistakes.h"
#include "host/scene/model.h"

namespace rt {

struct MtlLibrary {
    std::vector<Scene::Material> materials;
    std::vector<std::string> notes;  ///< what was left out, a sentence each
};

/// Reads a material library (Wavefront, 1992; docs/scene-format.md maps its keywords to ours). What
/// cannot be read is a note.
MtlLibrary parse_mtl(std::string_view text, const std::string& file_name);

/// The materials and libraries an OBJ refers to. Both may come in any order, so names are resolved
/// only after the whole file is read.
class ObjMaterials {
   public:
    /// A name and its offset in the OBJ.
    struct Use {
        std::string name;
        std::size_t offset = 0;
    };

    /// A material's number, in order of first use; -1 if the name is empty.
    int use(const Use& material);

    /// `libraries` is what an mtllib statement names.
    void use_library(const Use& libraries) { libraries_.push_back(libraries); }

    /// Reads the libraries, and turns the numbers in the model's face_materials into indices of its
    /// materials. Faces without a name, or with an unknown one, get a gray that is added there.
    void assign(Model& model, const OpenLibrary& open, Mistakes& mistakes);

   private:
    std::vector<Use> used_;  ///< first use of each name
    std::vector<Use> libraries_;
    std::unordered_map<std::string, int> numbers_;
};

/// The material of faces that have none in the file: matte gray, two-sided.
Scene::Material default_material();

}  // namespace rt
