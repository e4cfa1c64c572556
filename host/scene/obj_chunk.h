// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "host/scene/line_scanner.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene.h"

namespace rt {

/// A face that is neither a triangle nor a quadrilateral that passes parts_well.
struct ObjPolygon {
    std::vector<std::uint32_t> corners, normals;
};

/// The argument of a usemtl: a printable name, empty if missing.
struct ObjMaterialUse {
    std::string name;
    std::size_t offset = 0;  ///< after the word
};

/// What interrupts the triangles of a chunk.
struct ObjEvent {
    std::size_t faces_before = 0;
    std::variant<ObjPolygon, ObjMaterialUse> what;
};

struct ObjLibraryUse {
    std::string names;
    std::size_t offset = 0;
};

/// The number of vertices defined above a statement.
struct ObjCounts {
    std::size_t positions = 0, normals = 0;
};

/// A chunk of lines of an OBJ, filled in two passes, so that faces are read when all vertices are
/// known. Each pass notes its first 20 mistakes.
struct ObjChunk {
    ObjChunk(const Mistakes& of_file, std::size_t from, std::size_t to)
        : mistakes(of_file.part()), begin(from), end(to) {}

    Mistakes mistakes;
    std::size_t begin, end;  ///< offsets in the text

    std::vector<glm::dvec3> positions, normals;

    std::vector<Scene::Mesh::Face> faces;
    std::vector<Scene::Mesh::Face> face_normals;  ///< one for each face, or none
    std::vector<ObjEvent> events;
    std::vector<ObjLibraryUse> libraries;
    std::size_t left_out = 0;  ///< point and line statements
};

/// Reads v and vn. Invalid vertices count too, so that indices stay correct.
void read_obj_vertices(ObjChunk& chunk);

/// Reads all other statements. `above` counts the vertices in earlier chunks, `positions` holds all
/// of the file's.
void read_obj_faces(ObjChunk& chunk, ObjCounts above, const std::vector<glm::dvec3>& positions);

}  // namespace rt
