// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "host/scene/line_scanner.h"
#include "host/scene/model.h"

namespace rt {

/// The materials an OBJ names and the libraries it expects them in. Both may come in any order,
/// so names become materials only when the whole file is read.
class ObjMaterials {
   public:
    /// Reads what follows usemtl; the number of the name, -1 when there is none.
    int use(LineScanner& scanner);

    /// Reads what follows mtllib.
    void note_library(LineScanner& scanner);

    /// Reads the libraries: a model with their materials and notes, without mesh. A library that is
    /// not there is a note.
    Model load(const OpenLibrary& open, const Mistakes& mistakes);

    /// Whether load found that a library is not there.
    bool lacks_library() const { return lacks_library_; }

    /// Turns the numbers in face_materials into indices of model.materials. Faces without a name
    /// get a grey that is added there. So do names in no library if one lacks; else they are
    /// mistakes.
    void resolve(Model& model, Mistakes& mistakes) const;

   private:
    struct Name {
        std::string text;
        std::size_t offset;  ///< of its first use
    };

    std::vector<Name> used_, libraries_;
    std::unordered_map<std::string, int> numbers_;
    bool lacks_library_ = false;
};

/// What faces wear whose file says nothing: a matt grey, seen from both sides.
Scene::Material default_material();

}  // namespace rt
