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

/// A face of more corners is refused by the readers.
inline constexpr std::size_t max_face_corners = 10000;

/// Whether the diagonal from the first corner parts a quadrilateral well: the triangles on both of
/// its sides face much the same way, by more than rounding explains. True for most.
bool parts_well(const std::array<glm::dvec3, 4>& quad);

/// Appends a triangle, with normals or (null) without, to faces that have a row of normals each as
/// soon as one of them has normals.
void append_face(const Scene::Mesh::Face& face, const Scene::Mesh::Face* normals,
                 std::vector<Scene::Mesh::Face>& faces,
                 std::vector<Scene::Mesh::Face>& face_normals);

/// Takes a model's faces as its file gives them, of any number of corners, and makes the
/// triangles of a mesh. Positions and normals go straight into `mesh`.
class MeshBuilder {
   public:
    Scene::Mesh mesh;

    /// Triangles as they are; with a row of normals each, or none.
    void add_triangles(std::span<const Scene::Mesh::Face> faces,
                       std::span<const Scene::Mesh::Face> normals);

    /// Corners are indices into mesh.positions, 3 at least; normals into mesh.normals, as many or
    /// none. Both are below the sizes of these. Faces need not be flat. One that crosses itself, or
    /// is beyond the budget for polygons, becomes the triangles at its first corner; one without
    /// area becomes nothing.
    void add_face(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> normals);

    /// The material of the faces to come. Faces before the first call have material -1.
    void use_material(int material);

    /// The mesh, complete with face_materials.
    Scene::Mesh take();

    /// What add_face could not keep as it is, a sentence each.
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
