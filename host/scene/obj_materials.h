// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "host/scene/model.h"
#include "host/scene/obj_chunk.h"

namespace rt {

/// The materials an OBJ names and the libraries it expects them in. Both may come in any order,
/// so names become materials only when the whole file is read.
class ObjMaterials {
   public:
    /// The number of a name, in the order of first uses; -1 of an empty one.
    int use(const ObjMaterialUse& use);

    void note_library(const ObjLibraryUse& library) { libraries_.push_back(library); }

    /// Reads the libraries: a model with their materials and notes, without mesh. A library that is
    /// not there is a note.
    Model load(const OpenLibrary& open, const Mistakes& mistakes);

    /// Whether load found that a library is not there.
    bool lacks_library() const { return lacks_library_; }

    /// Turns the numbers in face_materials into indices of model.materials. Faces without a name
    /// get a gray that is added there. So do names in no library if one lacks; else they are
    /// mistakes.
    void resolve(Model& model, Mistakes& mistakes) const;

   private:
    std::vector<ObjMaterialUse> used_;  ///< first uses
    std::vector<ObjLibraryUse> libraries_;
    std::unordered_map<std::string, int> numbers_;
    bool lacks_library_ = false;
};

/// What faces wear whose file says nothing: a matt gray, seen from both sides.
Scene::Material default_material();

}  // namespace rt
