// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/scene/polygon.h"
#include "host/scene/scene.h"

namespace rt {

/// Readers refuse faces with more corners.
inline constexpr std::size_t max_face_corners = 10000;

/// Whether the diagonal from the first corner splits a quadrilateral well: both triangles face much
/// the same way, beyond rounding error. True for most.
bool parts_well(const std::array<glm::dvec3, 4>& quad);

/// Appends a triangle, with normals or (null) without. Once any face has normals, every face has a
/// row of them.
void append_face(const Scene::Mesh::Face& face, const Scene::Mesh::Face* normals,
                 std::vector<Scene::Mesh::Face>& faces,
                 std::vector<Scene::Mesh::Face>& face_normals);

/// Turns a model's faces, with any number of corners, into the triangles of a mesh. Readers write
/// positions and normals directly to `mesh`.
class MeshBuilder {
   public:
    Scene::Mesh mesh;

    /// Appends triangles unchanged; with a row of normals each, or none.
    void add_triangles(std::span<const Scene::Mesh::Face> faces,
                       std::span<const Scene::Mesh::Face> normals);

    /// `corners` are at least 3 indices into mesh.positions; `normals` as many into mesh.normals,
    /// or none. All must be in range. Faces need not be planar. One that crosses itself, or exceeds
    /// the polygon budget, becomes a fan from its first corner; one without area is dropped.
    void add_face(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> normals);

    /// Sets the material of subsequent faces. Faces before the first call have material -1.
    void use_material(int material);

    /// The mesh, complete with face_materials.
    Scene::Mesh take();

    /// What add_face dropped or could not triangulate exactly, a sentence each.
    std::vector<std::string> notes(const std::string& file_name) const;

   private:
    struct Run {
        std::size_t first_face;
        int material;
    };

    void split(std::span<const std::uint32_t> corners);
    std::vector<Run> runs_;
    std::vector<glm::dvec3> outline_;
    std::vector<Scene::Mesh::Face> parts_;  ///< of the face at hand
    std::int64_t work_ = max_polygon_work;
    std::size_t zero_areas_ = 0, fans_ = 0;
};

}  // namespace rt
