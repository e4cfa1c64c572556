// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/scene/geometry.h"
#include "host/scene/polygon.h"
#include "host/scene/scene.h"

namespace rt {

/// Readers refuse faces with more corners.
inline constexpr std::size_t max_face_corners = 10000;

/// Whether all coordinates are finite and within max_scene_number.
inline bool is_within(const glm::dvec3& p) {
    const auto good = [](double x) { return std::abs(x) <= max_scene_number; };
    return good(p.x) && good(p.y) && good(p.z);
}

/// Whether the diagonal from the first corner splits a quadrilateral well: both triangles face much
/// the same way, beyond rounding error. True for most.
bool parts_well(const std::array<glm::dvec3, 4>& quad);

/// Appends the triangles of a face of at least 3 corners, which are indices into positions;
/// `normals` are as many into the normals, or none. All must be in range. `face_normals` gets a row
/// for each triangle; null for a mesh without normals. `file_bytes` are as for split_polygon.
/// Returns what is wrong with the face, or null.
const PolygonBlemish* append_face(std::span<const std::uint32_t> corners,
                                  std::span<const std::uint32_t> normals,
                                  const std::vector<glm::dvec3>& positions, std::size_t file_bytes,
                                  std::vector<Scene::Mesh::Face>& faces,
                                  std::vector<Scene::Mesh::Face>* face_normals);

/// Transforms a mesh into the scene. Normals become unit length; triangles without area are
/// removed and faces with a normal of length 0 made flat, with a note; a mirroring transform
/// reverses the faces, so that fronts stay fronts. The transform must not be singular. Throws Error
/// (ExitCode::input) if a vertex ends up beyond max_scene_number, or if no face is left.
void finish_mesh(Scene::Mesh& mesh, const Affine& transform, const std::string& path,
                 std::vector<std::string>& notes);

/// The box of all faces; vertices of none do not count.
Box bounding_box(const Scene::Mesh& mesh);

struct BoundingSphere {
    glm::dvec3 center{0};
    double radius = 0;
};

/// Centered on the bounding box. The mesh has at least one face.
BoundingSphere bounding_sphere(const Scene::Mesh& mesh);

}  // namespace rt
