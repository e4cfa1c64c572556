// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_blocks.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "host/scene/mesh_builder.h"
#include "host/scene/scene_limits.h"

namespace rt {
namespace {

/// A value's position in its row.
struct Place {
    std::size_t offset = 0;
    PlyType type = PlyType::float32;
};

bool are_within(const glm::dvec3& v) {
    const auto good = [](double x) { return std::abs(x) <= max_scene_number; };
    return good(v.x) && good(v.y) && good(v.z);
}

bool read_vector(const char* row, const std::array<Place, 3>& places, bool swapped,
                 glm::dvec3& target) {
    for (int axis = 0; axis < 3; ++axis) {
        const Place& place = places[static_cast<std::size_t>(axis)];
        target[axis] = ply_number(row + place.offset, place.type, swapped);
    }
    return are_within(target);
}

/// The same for three consecutive floats in native byte order: the usual layout, without branching
/// on each value's type.
bool read_floats(const char* row, glm::dvec3& target) {
    std::array<float, 3> v;
    std::memcpy(v.data(), row, sizeof v);
    target = glm::dvec3(v[0], v[1], v[2]);
    return are_within(target);
}

bool are_floats(const std::array<Place, 3>& places, bool swapped) {
    return !swapped && std::ranges::all_of(places, [&](const Place& place) {
        const auto i = static_cast<std::size_t>(&place - places.data());
        return place.type == PlyType::float32 && place.offset == places[0].offset + 4 * i;
    });
}

/// Calls work(row) for all rows in parallel; returns whether all calls did.
template <typename Work>
bool all_rows(std::size_t rows, std::size_t row_bytes, const ReadPace& pace, Work work) {
    std::atomic<bool> good = true;
    const std::size_t grain = std::max<std::size_t>(pace.chunk_bytes / row_bytes, 1);
    for_each_run(rows, grain, pace.threads, [&](std::size_t first, std::size_t last) {
        bool all = true;
        for (std::size_t i = first; i < last; ++i) all &= work(i);
        if (!all) good = false;
    });
    return good;
}

/// The layout of a face row whose list has N items.
struct FaceLayout {
    std::size_t list = 0, first_item = 0, stride = 0;
    PlyType count_type = PlyType::uint8, item_type = PlyType::int32;
};

FaceLayout layout_of(const PlyElement& element, std::size_t items) {
    FaceLayout layout;
    for (const PlyProperty& property : element.properties) {
        if (property.is_list()) {
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

/// Reads faces of N corners each.
template <std::size_t N>
class FaceRows {
   public:
    using Corners = std::array<std::uint32_t, N>;

    FaceRows(const char* rows, const FaceLayout& layout, bool swapped, std::size_t vertices)
        : rows_(rows),
          layout_(layout),
          swapped_(swapped),
          usual_(!swapped && size_of(layout.count_type) == 1 && size_of(layout.item_type) == 4),
          vertices_(vertices) {}

    /// Whether a row has N corners, and all exist.
    bool read(std::size_t i, Corners& corners) const {
        const char* row = rows_ + i * layout_.stride;
        return usual_ ? read_usual(row, corners) : read_any(row, corners);
    }

   private:
    /// The usual layout: a count byte, then 32-bit indices in native byte order.
    bool read_usual(const char* row, Corners& corners) const {
        std::memcpy(corners.data(), row + layout_.first_item, sizeof corners);
        bool good = row[layout_.list] == N;
        for (const std::uint32_t corner : corners) good &= corner < vertices_;
        return good;
    }

    bool read_any(const char* row, Corners& corners) const {
        if (ply_whole(row + layout_.list, layout_.count_type, swapped_) != N) return false;
        bool good = true;
        for (std::size_t i = 0; i < N; ++i) {
            const char* item = row + layout_.first_item + i * size_of(layout_.item_type);
            const std::int64_t index = ply_whole(item, layout_.item_type, swapped_);
            good &= index >= 0 && static_cast<std::uint64_t>(index) < vertices_;
            corners[i] = static_cast<std::uint32_t>(index);
        }
        return good;
    }

    const char* rows_;
    const FaceLayout& layout_;
    const bool swapped_, usual_;
    const std::size_t vertices_;
};

}  // namespace

std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element) {
    std::size_t stride = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.is_list()) return std::nullopt;
        stride += size_of(property.type);
    }
    if (stride == 0 || data.size() / stride < element.count) return std::nullopt;
    return data.substr(0, element.count * stride);
}

bool read_columns(std::string_view rows, const PlyElement& element,
                  const std::array<std::size_t, 3>& properties, bool swapped,
                  std::vector<glm::dvec3>& target, const ReadPace& pace) {
    std::array<Place, 3> places{};
    std::size_t stride = 0;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyType type = element.properties[i].type;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (properties[axis] == i) places[axis] = {stride, type};
        }
        stride += size_of(type);
    }
    const bool floats = are_floats(places, swapped);
    target.resize(element.count);
    return all_rows(target.size(), stride, pace, [&](std::size_t i) {
        const char* row = rows.data() + i * stride;
        return floats ? read_floats(row + places[0].offset, target[i])
                      : read_vector(row, places, swapped, target[i]);
    });
}

std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace) {
    if (std::ranges::count_if(element.properties, &PlyProperty::is_list) != 1) return std::nullopt;
    const FaceLayout start = layout_of(element, 0);
    if (!is_whole(start.count_type) || !is_whole(start.item_type)) return std::nullopt;
    if (element.count == 0 || data.size() < start.stride) return std::nullopt;
    const std::int64_t corners = ply_whole(data.data() + start.list, start.count_type, swapped);
    if (corners != 3 && corners != 4) return std::nullopt;
    const FaceLayout layout = layout_of(element, static_cast<std::size_t>(corners));
    if (data.size() / layout.stride < element.count) return std::nullopt;
    PlyFaces read;
    read.bytes = element.count * layout.stride;
    read.faces.resize(element.count * (corners == 3 ? 1 : 2));
    bool good = false;
    if (corners == 3) {
        const FaceRows<3> rows(data.data(), layout, swapped, positions.size());
        good = all_rows(element.count, layout.stride, pace,
                        [&](std::size_t i) { return rows.read(i, read.faces[i]); });
    } else {
        const FaceRows<4> rows(data.data(), layout, swapped, positions.size());
        const auto& p = positions;
        good = all_rows(element.count, layout.stride, pace, [&](std::size_t i) {
            std::array<std::uint32_t, 4> c{};
            if (!rows.read(i, c) || !parts_well({p[c[0]], p[c[1]], p[c[2]], p[c[3]]})) return false;
            read.faces[2 * i] = {c[0], c[1], c[2]};
            read.faces[2 * i + 1] = {c[0], c[2], c[3]};
            return true;
        });
    }
    return good ? std::optional(std::move(read)) : std::nullopt;
}

}  // namespace rt
