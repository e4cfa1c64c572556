// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/scene/affine.h"
#include "host/scene/scene.h"

namespace rt {

/// What was dropped from a mesh.
struct MeshLosses {
    std::size_t zero_areas = 0;    ///< triangles without area
    std::size_t zero_normals = 0;  ///< vertex normals of length 0: their faces are flat
    bool too_far = false;          ///< a position ends up beyond max_scene_number
};

/// Transforms a mesh into the scene. Normals become unit length; triangles without area are
/// removed; a mirroring transform reverses the faces, so that fronts stay fronts. The transform
/// must not be singular.
MeshLosses finish_mesh(Scene::Mesh& mesh, const Affine& transform);

}  // namespace rt
