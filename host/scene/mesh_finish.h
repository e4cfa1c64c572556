// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/scene/affine.h"
#include "host/scene/scene.h"

namespace rt {

/// What was dropped from a mesh.
struct MeshLosses {
    std::size_t zero_areas = 0;  ///< triangles without area
    std::size_t flat_faces = 0;  ///< made flat, since a vertex normal has length 0
    bool too_far = false;        ///< a face's vertex ends up beyond max_scene_number
};

/// Transforms a mesh into the scene. Normals become unit length; triangles without area are
/// removed; a mirroring transform reverses the faces, so that fronts stay fronts. The transform
/// must not be singular.
MeshLosses finish_mesh(Scene::Mesh& mesh, const Affine& transform);

}  // namespace rt
