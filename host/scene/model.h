// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/scene/scene.h"

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

}  // namespace rt
