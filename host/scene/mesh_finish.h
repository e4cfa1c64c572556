// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/scene/affine.h"
#include "host/scene/scene.h"

namespace rt {

/// What had to be left out of a mesh.
struct MeshLosses {
    std::size_t zero_areas = 0;    ///< triangles without area
    std::size_t zero_normals = 0;  ///< vertex normals of length 0: their faces are flat
    bool too_far = false;          ///< a position ends up beyond max_scene_number
};

/// Puts a mesh in its place in the scene. Normals, of any length before, are unit length after;
/// triangles without area are gone; a transform that mirrors turns the faces round, so that their
/// fronts stay fronts. The transform is not singular.
MeshLosses finish_mesh(Scene::Mesh& mesh, const Affine& transform);

}  // namespace rt
