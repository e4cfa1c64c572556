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

/// A face that is neither a triangle nor a quadrilateral that parts well.
struct ObjPolygon {
    std::vector<std::uint32_t> corners, normals;
};

/// What follows a usemtl: a printable name, empty where there is none.
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

/// The vertices that stand above a statement.
struct ObjCounts {
    std::size_t positions = 0, normals = 0;
};

/// Some lines of an OBJ: two readers fill it in, one after the other, so that faces are read where
/// all vertices are known. Mistakes are noted, each reader's first 20.
struct ObjChunk {
    ObjChunk(const Mistakes& of_file, std::size_t from, std::size_t to)
        : mistakes(of_file.part()), begin(from), end(to) {}

    Mistakes mistakes;
    std::size_t begin, end;  ///< offsets in the text

    std::vector<glm::dvec3> positions, normals;

    std::vector<Scene::Mesh::Face> faces;
    std::vector<Scene::Mesh::Face> face_normals;  ///< as many, or none
    std::vector<ObjEvent> events;
    std::vector<ObjLibraryUse> libraries;
    std::size_t left_out = 0;  ///< statements of points and lines
};

/// Reads v and vn. A vertex that is wrong counts all the same, so that indices keep their meaning.
void read_obj_vertices(ObjChunk& chunk);

/// Reads all other statements. `above` tells the vertices of the chunks before, `positions` has all
/// of the file's.
void read_obj_faces(ObjChunk& chunk, ObjCounts above, const std::vector<glm::dvec3>& positions);

}  // namespace rt
