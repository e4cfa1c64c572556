// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "host/scene/model.h"
#include "host/scene/obj_chunk.h"

namespace rt {

/// The materials and libraries an OBJ refers to. Both may come in any order, so names are resolved
/// only after the whole file is read.
class ObjMaterials {
   public:
    /// A name's number, in order of first use; -1 if the name is empty.
    int use(const ObjMaterialUse& use);

    void note_library(const ObjLibraryUse& library) { libraries_.push_back(library); }

    /// Reads the libraries: a model with their materials and notes, without a mesh. A missing
    /// library is a note.
    Model load(const OpenLibrary& open, const Mistakes& mistakes);

    /// Whether load found a library missing.
    bool lacks_library() const { return lacks_library_; }

    /// Turns the numbers in face_materials into indices of model.materials. Faces without a name
    /// get a gray that is added there. So do names found in no library if one is missing; else they
    /// are mistakes.
    void resolve(Model& model, Mistakes& mistakes) const;

   private:
    std::vector<ObjMaterialUse> used_;  ///< first use of each name
    std::vector<ObjLibraryUse> libraries_;
    std::unordered_map<std::string, int> numbers_;
    bool lacks_library_ = false;
};

/// The material of faces that have none in the file: matte gray, two-sided.
Scene::Material default_material();

}  // namespace rt
