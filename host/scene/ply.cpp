// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply.h"

#include <fmt/format.h>

#include <atomic>
#include <iterator>
#include <utility>

#include "host/scene/mesh.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Elements, or properties of one: no model has a header with more.
constexpr std::size_t max_declared = 1000;

constexpr Remedy header_ignored{"line ignored", "lines ignored"};
constexpr Remedy version_ignored = header_ignored;

/// Each type has two names.
constexpr std::string_view type_names[] = {
    "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
    "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};

class HeaderReader {
   public:
    explicit HeaderReader(Mistakes& mistakes) : scanner_(mistakes.text()), mistakes_(mistakes) {}

    PlyHeader read() {
        if (scanner_.word() != "ply" || scanner_.word_follows()) {
            fail(0, "the file does not start with a line 'ply'; use a PLY file");
        }
        read_lines();
        if (!has_format_) {
            mistakes_.add(0, "the header has no format; add 'format ascii 1.0' below 'ply'");
        }
        mistakes_.throw_if_any();
        header_.data_offset = scanner_.offset();
        return std::move(header_);
    }

   private:
    void fail(std::size_t offset, std::string message) {
        mistakes_.add(offset, std::move(message));
        mistakes_.throw_if_any();
    }

    /// Data follows the last line and may begin with any byte. So a line feed after a carriage
    /// return belongs to the line, unless the header's lines end with carriage returns alone.
    void skip_last_line_end() {
        const std::string_view text = mistakes_.text();
        const std::size_t first_end = std::min(text.find_first_of("\r\n"), text.size());
        const bool only_returns =
            text.substr(first_end, 1) == "\r" && text.substr(first_end, 2) != "\r\n";
        scanner_.rest();
        if (scanner_.bytes_left() == 0) return;
        scanner_.advance(!only_returns && scanner_.left().starts_with("\r\n") ? 2 : 1);
    }

    void read_lines() {
        while (true) {
            scanner_.next_line();
            if (!scanner_.find_word()) {
                fail(scanner_.offset(), "the header has no end; add a line end_header");
            }
            offset_ = scanner_.offset();
            const std::string_view word = scanner_.word();
            if (word == "end_header") return skip_last_line_end();
            read_line(word);
        }
    }

    void read_line(std::string_view word) {
        if (word == "comment" || word == "obj_info") return;
        if (word == "format") return read_format();
        if (word == "element") return read_element();
        if (word == "property") return read_property();
        mistakes_.note(header_ignored, offset_, "unknown word {} in the header", in_quotes(word));
    }

    void read_format() {
        constexpr std::string_view names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        const std::string_view name = scanner_.word(), version = scanner_.word();
        const auto found = std::ranges::find(names, name);
        const auto format = static_cast<PlyFormat>(found - std::begin(names));
        if (found == std::end(names)) {
            mistakes_.add(offset, "unknown format {}; known formats are {}", in_quotes(name),
                          word_list(names));
        } else if (has_format_ && format != header_.format) {
            mistakes_.add(offset_, "the format is given twice; keep one");
        } else if (has_format_ || version != "1.0") {
            mistakes_.note(version_ignored, offset,
                           "the format is given twice, or its version is {} and not 1.0",
                           in_quotes(version));
        }
        header_.format = format;
        has_format_ = true;
    }

    void read_element() {
        PlyElement element;
        element.offset = offset_;
        element.name = scanner_.word();
        const bool there = scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        const auto count = there ? scanner_.integer() : std::nullopt;
        if (!count || *count < 0) {
            mistakes_.add(offset, "the count of element {} is {}; write a whole number, 0 or more",
                          in_quotes(element.name), found_text(scanner_, there, count));
        } else {
            element.count = static_cast<std::uint64_t>(*count);
        }
        if (header_.elements.size() >= max_declared) {
            fail(offset_,
                 fmt::format("more than {} elements; check that this is a PLY file", max_declared));
        }
        header_.elements.push_back(std::move(element));
    }

    std::optional<PlyType> read_type() {
        scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        const auto found = std::ranges::find(type_names, word);
        if (found != std::end(type_names)) {
            return static_cast<PlyType>((found - std::begin(type_names)) / 2);
        }
        if (header_.format == PlyFormat::ascii && has_format_) return PlyType::float64;
        mistakes_.add(offset,
                      "unknown type {}; write char, uchar, short, ushort, "
                      "int, uint, float or double",
                      in_quotes(word));
        return std::nullopt;
    }

    /// Names may be missing or repeated, as of padding: the first of a name counts.
    void read_property() {
        if (header_.elements.empty()) {
            mistakes_.note(header_ignored, offset_, "a property comes before the first element");
            return;
        }
        PlyProperty property;
        if (LineScanner ahead = scanner_; ahead.word() == "list") {
            scanner_ = ahead;
            scanner_.word_follows();
            const std::size_t offset = scanner_.offset();
            property.count_type = read_type();
            if (!property.count_type) return;
            if (!is_whole(*property.count_type) && header_.format != PlyFormat::ascii) {
                mistakes_.add(offset, "a list's length must be a whole number; write uchar or int");
            }
        }
        const auto type = read_type();
        if (!type) return;
        property.type = *type;
        property.name = scanner_.word();
        PlyElement& element = header_.elements.back();
        if (element.properties.size() >= max_declared) {
            fail(offset_, fmt::format("more than {} properties; check that this is a PLY file",
                                      max_declared));
        }
        element.properties.push_back(std::move(property));
    }

    LineScanner scanner_;
    Mistakes& mistakes_;
    PlyHeader header_;
    std::size_t offset_ = 0;  ///< of the line being read
    bool has_format_ = false;
};

void check_vertex(const PlyElement& vertex, Mistakes& mistakes) {
    for (const std::string_view name : {"x", "y", "z"}) {
        const std::size_t place = vertex.find(name);
        if (place == vertex.properties.size()) {
            mistakes.add(vertex.offset,
                         "the vertices have no property {}; declare "
                         "x, y and z",
                         in_quotes(name));
        } else if (vertex.properties[place].is_list()) {
            mistakes.add(vertex.offset, "property {} of the vertices is a list; declare one number",
                         in_quotes(name));
        }
    }
}

/// Checks the list of faces or strips.
void check_corners(const PlyElement& element, PlyFormat format, Mistakes& mistakes) {
    const std::string_view what = element.name == "face" ? "faces" : "strips";
    const std::size_t place = element.find_corners();
    if (place == element.properties.size()) {
        mistakes.add(element.offset,
                     "the {} have no property 'vertex_indices'; declare 'property "
                     "list uchar int vertex_indices'",
                     what);
        return;
    }
    const PlyProperty& list = element.properties[place];
    if (!list.is_list() || (format != PlyFormat::ascii && !is_whole(list.type))) {
        const std::string& name = list.name;
        mistakes.add(element.offset,
                     "property {} of the {} is not a list of whole "
                     "numbers; declare 'property list uchar int {}'",
                     in_quotes(name), what, name);
    }
}

void check_header(const PlyHeader& header, Mistakes& mistakes) {
    int vertices = 0, faces = 0;
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            if (vertices++ > 0) {
                mistakes.add(element.offset, "element 'vertex' is declared twice; keep one");
            } else {
                check_vertex(element, mistakes);
            }
        } else if (element.name == "face" || element.name == "tristrips") {
            ++faces;
            check_corners(element, header.format, mistakes);
        }
    }
    if (vertices == 0) mistakes.add(0, "the header declares no element 'vertex'; use a mesh");
    if (faces == 0) {
        mistakes.add(0,
                     "the header declares no element 'face'; points alone cannot be drawn; use a "
                     "mesh");
    }
    mistakes.throw_if_any();
}

/// A value's position in its row.
struct Place {
    std::size_t offset = 0;
    PlyType type = PlyType::float32;
};

bool read_vector(const char* row, const std::array<Place, 3>& places, bool swapped,
                 glm::dvec3& target) {
    for (int axis = 0; axis < 3; ++axis) {
        const Place& place = places[static_cast<std::size_t>(axis)];
        target[axis] = ply_number(row + place.offset, place.type, swapped);
    }
    return is_within(target);
}

/// The same for three consecutive floats in native byte order: the usual layout, without branching
/// on each value's type.
bool read_floats(const char* row, glm::dvec3& target) {
    std::array<float, 3> v;
    std::memcpy(v.data(), row, sizeof v);
    target = glm::dvec3(v[0], v[1], v[2]);
    return is_within(target);
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

/// Reads the N corners of a row; returns whether it has so many, and all exist. `usual` rows have a
/// count byte, then 32-bit indices in native byte order.
template <std::size_t N>
bool read_corners(const char* row, const FaceLayout& layout, bool usual, bool swapped,
                  std::size_t vertices, std::array<std::uint32_t, N>& corners) {
    const char* item = row + layout.first_item;
    bool good = true;
    if (usual) {
        std::memcpy(corners.data(), item, sizeof corners);
        good = row[layout.list] == N;
        for (const std::uint32_t corner : corners) good &= corner < vertices;
        return good;
    }
    if (ply_whole(row + layout.list, layout.count_type, swapped) != N) return false;
    for (std::uint32_t& corner : corners) {
        const std::int64_t index = ply_whole(item, layout.item_type, swapped);
        item += size_of(layout.item_type);
        good &= index >= 0 && static_cast<std::uint64_t>(index) < vertices;
        corner = static_cast<std::uint32_t>(index);
    }
    return good;
}

}  // namespace

std::size_t PlyElement::find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    return static_cast<std::size_t>(found - properties.begin());
}

std::size_t PlyElement::find_corners() const {
    return std::min(find("vertex_indices"), find("vertex_index"));
}

std::size_t PlyElement::least_bytes(PlyFormat format) const {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        bytes +=
            format == PlyFormat::ascii ? 2 : size_of(property.count_type.value_or(property.type));
    }
    return bytes;
}

PlyHeader parse_ply_header(Mistakes& mistakes) {
    PlyHeader header = HeaderReader(mistakes).read();
    check_header(header, mistakes);
    return header;
}

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
    const bool usual =
        !swapped && size_of(layout.count_type) == 1 && size_of(layout.item_type) == 4;
    const auto& p = positions;
    const auto read_row = [&](std::size_t i) {
        const char* row = data.data() + i * layout.stride;
        if (corners == 3) {
            return read_corners<3>(row, layout, usual, swapped, p.size(), read.faces[i]);
        }
        std::array<std::uint32_t, 4> c{};
        if (!read_corners<4>(row, layout, usual, swapped, p.size(), c)) return false;
        read.faces[2 * i] = {c[0], c[1], c[2]};
        read.faces[2 * i + 1] = {c[0], c[2], c[3]};
        return parts_well({p[c[0]], p[c[1]], p[c[2]], p[c[3]]});
    };
    const bool good = all_rows(element.count, layout.stride, pace, read_row);
    return good ? std::optional(std::move(read)) : std::nullopt;
}

}  // namespace rt
