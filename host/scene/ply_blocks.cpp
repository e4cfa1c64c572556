// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_blocks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "host/scene/mesh_builder.h"
#include "host/scene/ply_value.h"
#include "host/scene/scene_limits.h"

namespace rt {
namespace {

/// A value's position in its row.
struct Place {
    std::size_t offset = 0;
    PlyType type = PlyType::float32;
};

using VectorPlaces = std::array<Place, 3>;

/// The places of three values by name, in rows without lists; empty when one is missing.
std::optional<VectorPlaces> places_of(const PlyElement& element,
                                      const std::array<std::string_view, 3>& names) {
    VectorPlaces places{};
    int found = 0;
    std::size_t offset = 0;
    for (const PlyProperty& property : element.properties) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (property.name != names[i]) continue;
            places[i] = {offset, property.type};
            ++found;
        }
        offset += size_of(property.type);
    }
    return found == 3 ? std::optional(places) : std::nullopt;
}

/// Whether all three are numbers in range.
bool read_vector(const char* row, const VectorPlaces& places, bool swapped, glm::dvec3& target) {
    bool good = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Place& place = places[static_cast<std::size_t>(axis)];
        target[axis] = ply_number(row + place.offset, place.type, swapped);
        good = good && std::abs(target[axis]) <= max_scene_number;
    }
    return good;
}

/// The same for three consecutive floats in native byte order: the usual layout, without branching
/// on each value's type.
bool read_floats(const char* row, glm::dvec3& target) {
    std::array<float, 3> v;
    std::memcpy(v.data(), row, sizeof v);
    target = glm::dvec3(v[0], v[1], v[2]);
    const auto good = [](double x) { return std::abs(x) <= max_scene_number; };
    return good(target.x) && good(target.y) && good(target.z);
}

bool are_floats(const VectorPlaces& places, bool swapped) {
    return !swapped && std::ranges::all_of(places, [&](const Place& place) {
        const auto i = static_cast<std::size_t>(&place - places.data());
        return place.type == PlyType::float32 && place.offset == places[0].offset + 4 * i;
    });
}

/// Calls work(first, last) on runs of rows in parallel; returns false if any call did.
template <typename Work>
bool all_rows(std::size_t rows, std::size_t row_bytes, const ReadPace& pace, Work work) {
    std::atomic<bool> good = true;
    const std::size_t grain = std::max<std::size_t>(pace.chunk_bytes / row_bytes, 1);
    for_each_run(rows, grain, pace.threads, [&](std::size_t first, std::size_t last) {
        if (good && !work(first, last)) good = false;
    });
    return good;
}

bool read_column(std::string_view rows, std::size_t stride, const VectorPlaces& places,
                 bool swapped, std::vector<glm::dvec3>& target, const ReadPace& pace) {
    const bool floats = are_floats(places, swapped);
    target.resize(rows.size() / stride);
    return all_rows(target.size(), stride, pace, [&](std::size_t first, std::size_t last) {
        bool good = true;
        for (std::size_t i = first; i < last; ++i) {
            const char* row = rows.data() + i * stride;
            good &= floats ? read_floats(row + places[0].offset, target[i])
                           : read_vector(row, places, swapped, target[i]);
        }
        return good;
    });
}

/// The layout of a face row whose list has a given number of items.
struct FaceLayout {
    std::size_t list = 0, first_item = 0, stride = 0;
    PlyType count_type = PlyType::uint8, item_type = PlyType::int32;
};

FaceLayout layout_of(const PlyElement& element, std::size_t items) {
    FaceLayout layout;
    for (const PlyProperty& property : element.properties) {
        if (property.count_type) {
            layout.list = layout.stride;
            layout.count_type = *property.count_type;
            layout.item_type = property.type;
            layout.stride += size_of(*property.count_type);
            layout.first_item = layout.stride;
            layout.stride += items * size_of(property.type);
        } else {
            layout.stride += size_of(property.type);
        }
    }
    return layout;
}

using Face = Scene::Mesh::Face;

/// Reads N corners of a row; returns whether it has exactly N and all exist.
template <std::size_t N>
bool read_row(const char* row, const FaceLayout& layout, bool swapped, std::size_t vertices,
              std::array<std::uint32_t, N>& corners) {
    if (ply_whole(row + layout.list, layout.count_type, swapped) != N) return false;
    bool good = true;
    for (std::size_t i = 0; i < N; ++i) {
        const char* item = row + layout.first_item + i * size_of(layout.item_type);
        const std::int64_t index = ply_whole(item, layout.item_type, swapped);
        good &= index >= 0 && static_cast<std::uint64_t>(index) < vertices;
        corners[i] = static_cast<std::uint32_t>(index);
    }
    return good;
}

/// The usual layout: a count byte, then 32-bit indices in native byte order.
bool is_usual(const FaceLayout& layout, bool swapped) {
    return !swapped && size_of(layout.count_type) == 1 && size_of(layout.item_type) == 4;
}

template <std::size_t N>
bool read_usual_row(const char* row, const FaceLayout& layout, std::size_t vertices,
                    std::array<std::uint32_t, N>& corners) {
    std::memcpy(corners.data(), row + layout.first_item, sizeof corners);
    bool good = row[layout.list] == N;
    for (const std::uint32_t corner : corners) good &= corner < vertices;
    return good;
}

bool read_triangles(const char* rows, const FaceLayout& layout, bool swapped, std::size_t vertices,
                    std::vector<Face>& faces, const ReadPace& pace) {
    const bool usual = is_usual(layout, swapped);
    return all_rows(faces.size(), layout.stride, pace, [&](std::size_t first, std::size_t last) {
        bool good = true;
        for (std::size_t i = first; i < last; ++i) {
            const char* row = rows + i * layout.stride;
            good &= usual ? read_usual_row<3>(row, layout, vertices, faces[i])
                          : read_row<3>(row, layout, swapped, vertices, faces[i]);
        }
        return good;
    });
}

bool read_quads(const char* rows, const FaceLayout& layout, bool swapped,
                const std::vector<glm::dvec3>& p, std::vector<Face>& faces, const ReadPace& pace) {
    return all_rows(
        faces.size() / 2, layout.stride, pace, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                std::array<std::uint32_t, 4> c{};
                if (!read_row<4>(rows + i * layout.stride, layout, swapped, p.size(), c))
                    return false;
                if (!parts_well({p[c[0]], p[c[1]], p[c[2]], p[c[3]]})) return false;
                faces[2 * i] = {c[0], c[1], c[2]};
                faces[2 * i + 1] = {c[0], c[2], c[3]};
            }
            return true;
        });
}

}  // namespace

std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element) {
    std::size_t stride = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.count_type) return std::nullopt;
        stride += size_of(property.type);
    }
    if (stride == 0 || data.size() / stride < element.count) return std::nullopt;
    return data.substr(0, element.count * stride);
}

std::optional<PlyVertices> read_vertex_block(std::string_view rows, const PlyElement& element,
                                             bool swapped, const ReadPace& pace) {
    PlyVertices vertices;
    const auto positions = places_of(element, {"x", "y", "z"});
    const auto normals = places_of(element, {"nx", "ny", "nz"});
    if (!positions || rows.empty()) return std::nullopt;
    const std::size_t stride = rows.size() / element.count;
    if (!read_column(rows, stride, *positions, swapped, vertices.positions, pace)) return {};
    if (normals && !read_column(rows, stride, *normals, swapped, vertices.normals, pace)) return {};
    return vertices;
}

std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace) {
    const auto is_list = [](const PlyProperty& property) {
        return property.count_type.has_value();
    };
    if (std::ranges::count_if(element.properties, is_list) != 1) return std::nullopt;
    const FaceLayout start = layout_of(element, 0);
    if (element.count == 0 || data.size() < start.stride) return std::nullopt;
    const std::int64_t corners = ply_whole(data.data() + start.list, start.count_type, swapped);
    if (corners != 3 && corners != 4) return std::nullopt;
    const FaceLayout layout = layout_of(element, static_cast<std::size_t>(corners));
    if (data.size() / layout.stride < element.count) return std::nullopt;
    PlyFaces read;
    read.bytes = element.count * layout.stride;
    read.faces.resize(element.count * (corners == 3 ? 1 : 2));
    const bool good =
        corners == 3
            ? read_triangles(data.data(), layout, swapped, positions.size(), read.faces, pace)
            : read_quads(data.data(), layout, swapped, positions, read.faces, pace);
    return good ? std::optional(std::move(read)) : std::nullopt;
}

}  // namespace rt
