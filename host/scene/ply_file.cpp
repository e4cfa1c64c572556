// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>

#include "host/scene/mesh_builder.h"
#include "host/scene/ply_blocks.h"
#include "host/scene/ply_header.h"
#include "host/scene/ply_rows.h"
#include "host/scene/scene_limits.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::string_view vertex_columns[] = {"x", "y", "z", "nx", "ny", "nz"};
constexpr std::size_t column_count = std::size(vertex_columns);
constexpr std::size_t not_used = column_count;

bool is_corner_list(const PlyProperty& property) {
    return property.name == "vertex_indices" || property.name == "vertex_index";
}

/// Notes required properties that the header does not declare.
void check_vertex(const PlyElement& vertex, Mistakes& mistakes) {
    for (const std::string_view name : vertex_columns) {
        const PlyProperty* property = vertex.find(name);
        if (property && property->count_type) {
            mistakes.add(vertex.offset,
                         fmt::format("property {} of the vertices is a list; declare one number",
                                     in_quotes(name)));
        } else if (!property && name.size() == 1) {
            mistakes.add(vertex.offset, fmt::format("the vertices have no property {}; declare "
                                                    "x, y and z",
                                                    in_quotes(name)));
        }
    }
}

/// Checks the list of faces or strips.
void check_corners(const PlyElement& element, std::string_view what, Mistakes& mistakes) {
    const auto list = std::ranges::find_if(element.properties, is_corner_list);
    if (list == element.properties.end()) {
        mistakes.add(element.offset,
                     fmt::format("the {} have no property 'vertex_indices'; declare 'property "
                                 "list uchar int vertex_indices'",
                                 what));
    } else if (!list->count_type || !is_whole(list->type)) {
        mistakes.add(element.offset, fmt::format("property {} of the {} is not a list of whole "
                                                 "numbers; declare 'property list uchar int {}'",
                                                 in_quotes(list->name), what, list->name));
    }
}

void check_header(const PlyHeader& header, Mistakes& mistakes) {
    const PlyElement* vertex = header.find("vertex");
    const PlyElement* face = header.find("face");
    const PlyElement* strips = header.find("tristrips");
    if (!vertex) mistakes.add(0, "the header declares no element 'vertex'; use a mesh");
    if (!face && !strips) {
        mistakes.add(0,
                     "the header declares no element 'face'; points alone cannot be drawn; use a "
                     "mesh");
    }
    if (vertex) check_vertex(*vertex, mistakes);
    if (face) check_corners(*face, "faces", mistakes);
    if (strips) check_corners(*strips, "strips", mistakes);
    for (const PlyElement* element : {face, strips}) {
        if (!vertex || !element || element > vertex) continue;
        mistakes.add(element->offset,
                     fmt::format("the {} come before the vertices; save the vertices first",
                                 element == face ? "faces" : "strips"));
    }
    mistakes.throw_if_any();
}

template <typename Rows>
class BodyReader {
   public:
    BodyReader(const PlyHeader& header, Rows rows, Mistakes& mistakes, const ReadPace& pace)
        : header_(header), rows_(std::move(rows)), mistakes_(mistakes), pace_(pace) {}

    Model read(const std::string& file_name) {
        for (const PlyElement& element : header_.elements) {
            check_count(element);
            read_element(element);
        }
        const std::string leftover = rows_.leftover();
        mistakes_.throw_if_any();
        Model model;
        model.mesh = builder_.take();
        model.notes = builder_.notes(file_name);
        model.mesh.face_materials = {-1};
        if (!model.mesh.normals.empty()) model.mesh.face_normals = model.mesh.faces;
        if (!leftover.empty()) model.notes.push_back(file_name + ": " + leftover);
        return model;
    }

   private:
    /// Checks a declared row count against the bytes that are left.
    void check_count(const PlyElement& element) {
        const std::size_t least = element.least_bytes(header_.format);
        if (least == 0) return;
        const std::uint64_t most = (rows_.bytes_left() + 1) / least;
        if (element.count <= most) return;
        mistakes_.add(
            element.offset,
            fmt::format("element {} declares {} rows, but the rest of the file holds at most {}; "
                        "correct the count or save the model again",
                        in_quotes(element.name), element.count, most));
        mistakes_.throw_if_any();
    }

    void read_element(const PlyElement& element) {
        if (element.properties.empty()) return;
        if (element.name == "vertex") return read_vertices(element);
        if (element.name == "face") return read_faces(element);
        if (element.name == "tristrips") return read_strips(element);
        read_rows(element, [&] {
            return std::ranges::all_of(element.properties,
                                       [&](const PlyProperty& property) { return skip(property); });
        });
    }

    /// Calls read_row for each row. Throws if a row is truncated.
    template <typename ReadRow>
    void read_rows(const PlyElement& element, ReadRow read_row) {
        for (std::uint64_t row = 0; row < element.count; ++row) {
            rows_.start_row(element, row);
            if (!rows_.lost()) read_row();
            if (rows_.lost()) mistakes_.throw_if_any();
            rows_.end_row();
        }
    }

    /// Reads the length of a list; throws if it is negative.
    std::optional<std::uint64_t> list_length(const PlyProperty& list) {
        const auto length = rows_.integer(*list.count_type);
        if (!length) return std::nullopt;
        if (*length >= 0) return static_cast<std::uint64_t>(*length);
        rows_.note(fmt::format("the length of list {} is {}; write 0 or more", in_quotes(list.name),
                               *length));
        mistakes_.throw_if_any();
        return std::nullopt;
    }

    bool skip(const PlyProperty& property) {
        if (!property.count_type) return rows_.skip(property.type, 1);
        const auto length = list_length(property);
        return length && rows_.skip(property.type, *length);
    }

    /// Reads all rows in parallel if they are uniform and valid; returns whether it did.
    bool read_vertices_side_by_side(const PlyElement& element) {
        if constexpr (std::is_same_v<Rows, BinaryRows>) {
            const auto rows = fixed_rows(rows_.left(), element);
            if (!rows) return false;
            auto block = read_vertex_block(*rows, element, rows_.swapped(), pace_);
            if (!block) return false;
            builder_.mesh.positions = std::move(block->positions);
            builder_.mesh.normals = std::move(block->normals);
            rows_.advance(rows->size());
            return true;
        }
        return false;
    }

    bool read_faces_side_by_side(const PlyElement& element) {
        if constexpr (std::is_same_v<Rows, BinaryRows>) {
            auto block = read_face_block(rows_.left(), element, rows_.swapped(),
                                         builder_.mesh.positions, pace_);
            if (!block) return false;
            if (builder_.mesh.faces.empty()) {
                builder_.mesh.faces = std::move(block->faces);
            } else {
                builder_.add_triangles(block->faces, {});
            }
            rows_.advance(block->bytes);
            return true;
        }
        return false;
    }

    void read_vertices(const PlyElement& element) {
        if (read_vertices_side_by_side(element)) return;
        const bool smooth = element.find("nx") && element.find("ny") && element.find("nz");
        const std::span<const std::string_view> used(vertex_columns, smooth ? column_count : 3);
        std::vector<std::size_t> columns;
        for (const PlyProperty& property : element.properties) {
            const auto found = std::ranges::find(used, property.name);
            columns.push_back(found == used.end() ? not_used
                                                  : static_cast<std::size_t>(found - used.begin()));
        }
        Scene::Mesh& mesh = builder_.mesh;
        mesh.positions.reserve(element.count);
        if (smooth) mesh.normals.reserve(element.count);
        read_rows(element, [&] {
            std::array<double, column_count> values{};
            read_vertex(element, columns, values);
            mesh.positions.emplace_back(values[0], values[1], values[2]);
            if (smooth) mesh.normals.emplace_back(values[3], values[4], values[5]);
        });
    }

    void read_vertex(const PlyElement& element, const std::vector<std::size_t>& columns,
                     std::array<double, column_count>& values) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (columns[i] == not_used) {
                if (!skip(property)) return;
                continue;
            }
            const auto number = rows_.number(property.type);
            if (!number) return;
            values[columns[i]] = *number;
            if (std::abs(*number) <= max_scene_number) continue;
            rows_.note(fmt::format("{} is {}; write a number from -1e30 to 1e30",
                                   in_quotes(property.name), *number));
        }
    }

    void read_faces(const PlyElement& element) {
        if (read_faces_side_by_side(element)) return;
        constexpr std::uint64_t triangle_bytes = 8;  // "3 0 1 2\n"; usual binary rows take more
        const std::uint64_t triangles =
            std::min(element.count, rows_.bytes_left() / triangle_bytes);
        builder_.mesh.faces.reserve(triangles);
        const auto list = std::ranges::find_if(element.properties, is_corner_list);
        read_rows(element, [&] {
            for (auto property = element.properties.begin(); property != element.properties.end();
                 ++property) {
                if (!(property == list ? read_corners(*property) : skip(*property))) return;
            }
            if (mistakes_.count() == 0) builder_.add_face(corners_, {});
        });
    }

    /// Returns whether the next value can be read; invalid indices are only noted.
    bool read_corners(const PlyProperty& list) {
        const auto length = list_length(list);
        if (!length) return false;
        if (*length < 3 || *length > max_face_corners) {
            rows_.note(
                fmt::format("the face has {} corners; use 3 to {}", *length, max_face_corners));
            return rows_.skip(list.type, *length);
        }
        corners_.clear();
        for (std::uint64_t i = 0; i < *length; ++i) {
            const auto index = rows_.integer(list.type);
            if (!index) return false;
            check_index(*index);
            corners_.push_back(static_cast<std::uint32_t>(*index));
        }
        return true;
    }

    void check_index(std::int64_t index) {
        const std::size_t count = builder_.mesh.positions.size();
        if (index >= 0 && static_cast<std::uint64_t>(index) < count) return;
        rows_.note(fmt::format(
            "vertex {} does not exist, there are {}, counted from 0; correct the number", index,
            count));
    }

    void read_strips(const PlyElement& element) {
        read_rows(element, [&] {
            for (const PlyProperty& property : element.properties) {
                if (!(is_corner_list(property) ? read_strip(property) : skip(property))) return;
            }
        });
    }

    /// Triangles of three consecutive vertices, with alternating winding. -1 starts a new strip.
    /// Triangles with a repeated vertex are skipped.
    bool read_strip(const PlyProperty& list) {
        const auto length = list_length(list);
        if (!length) return false;
        corners_.clear();
        bool turned = false;
        for (std::uint64_t i = 0; i < *length; ++i) {
            const auto index = rows_.integer(list.type);
            if (!index) return false;
            if (*index == -1) {
                corners_.clear();
                turned = false;
                continue;
            }
            check_index(*index);
            corners_.push_back(static_cast<std::uint32_t>(*index));
            if (corners_.size() < 3) continue;
            if (mistakes_.count() == 0) add_strip_triangle(turned);
            corners_.erase(corners_.begin());
            turned = !turned;
        }
        return true;
    }

    void add_strip_triangle(bool turned) {
        const auto [a, b, c] = std::array{corners_[0], corners_[1], corners_[2]};
        if (a == b || b == c || c == a) return;
        builder_.add_face(turned ? std::array{b, a, c} : std::array{a, b, c}, {});
    }

    const PlyHeader& header_;
    Rows rows_;
    Mistakes& mistakes_;
    ReadPace pace_;
    MeshBuilder builder_;
    std::vector<std::uint32_t> corners_;  ///< of the face being read
};

}  // namespace

Model parse_ply(std::string_view text, const std::string& file_name, const ReadPace& pace) {
    Mistakes mistakes(text, file_name);
    const PlyHeader header = parse_ply_header(mistakes);
    check_header(header, mistakes);
    if (header.format == PlyFormat::ascii) {
        return BodyReader(header, TextRows(text, header, mistakes), mistakes, pace).read(file_name);
    }
    return BodyReader(header, BinaryRows(text, header, mistakes), mistakes, pace).read(file_name);
}

}  // namespace rt
