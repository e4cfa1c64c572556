// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

/// Takes a model's faces as its file gives them, of any number of corners, and makes the
/// triangles of a mesh. Positions and normals go straight into `mesh`.
class MeshBuilder {
   public:
    Scene::Mesh mesh;

    /// Corners are indices into mesh.positions, 3 at least; normals into mesh.normals, as many or
    /// none. Both are below the sizes of these.
    void add_face(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> normals);

    /// The material of the faces to come. Faces before the first call have material -1.
    void use_material(int material);

    /// The mesh, complete with face_materials.
    Scene::Mesh take();

   private:
    struct Run {
        std::size_t first_face;
        int material;
    };

    void add_triangle(const Scene::Mesh::Face& face, const Scene::Mesh::Face* normals);

    std::vector<Run> runs_;
    std::vector<glm::dvec3> outline_;
};

}  // namespace rt
