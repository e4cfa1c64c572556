// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "host/scene/line_scanner.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr Remedy header_ignored{"line ignored", "lines ignored"};

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
        mistakes_.add(offset, "{}", message);
        mistakes_.throw_if_any();
    }

    void read_lines() {
        while (true) {
            scanner_.next_line();
            if (!scanner_.find_word()) {
                fail(scanner_.offset(), "the header has no end; add a line end_header");
            }
            offset_ = scanner_.offset();
            const std::string_view word = scanner_.word();
            if (word == "end_header") {
                scanner_.rest();  // is no comment, for data follows
                return scanner_.next_line();
            }
            read_line(word);
        }
    }

    void read_line(std::string_view word) {
        if (word == "comment" || word == "obj_info") return static_cast<void>(scanner_.rest());
        if (word == "format") return read_format();
        if (word == "element") return read_element();
        if (word == "property") return read_property();
        mistakes_.note(header_ignored, offset_, "unknown word {} in the header", in_quotes(word));
    }

    void read_format() {
        constexpr std::string_view names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        const std::size_t offset = scanner_.word_offset();
        const std::string_view name = scanner_.word();
        const auto found = std::ranges::find(names, name);
        if (found == std::end(names)) {
            mistakes_.add(offset, "unknown format {}; known formats are {}", in_quotes(name),
                          word_list(names));
        }
        header_.format = static_cast<PlyFormat>(found - std::begin(names));
        has_format_ = true;
    }

    void read_element() {
        PlyElement element;
        element.offset = offset_;
        element.name = scanner_.word();
        const std::size_t offset = scanner_.word_offset();
        const auto count = scanner_.integer();
        if (!count || *count < 0) {
            mistakes_.add(offset, "the count of element {} is {}; write a whole number, 0 or more",
                          in_quotes(element.name), found_text(scanner_, count));
        } else {
            element.count = static_cast<std::uint64_t>(*count);
        }
        header_.elements.push_back(std::move(element));
    }

    std::optional<PlyType> read_type() {
        const std::size_t offset = scanner_.word_offset();
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
            const std::size_t offset = scanner_.word_offset();
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
        header_.elements.back().properties.push_back(std::move(property));
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
            if (faces++ == 0 && vertices == 0) {
                mistakes.add(element.offset,
                             "the header declares no element 'vertex' above this one; use a mesh");
            }
            check_corners(element, header.format, mistakes);
        }
    }
    if (faces == 0) {
        mistakes.add(0,
                     "the header declares no element 'face'; points alone cannot be drawn; use a "
                     "mesh");
    }
    mistakes.throw_if_any();
}

}  // namespace

std::size_t PlyElement::find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    return static_cast<std::size_t>(found - properties.begin());
}

std::size_t PlyElement::find_corners() const {
    return std::min(find("vertex_indices"), find("vertex_index"));
}

std::size_t PlyElement::list_count() const {
    return static_cast<std::size_t>(std::ranges::count_if(properties, &PlyProperty::is_list));
}

std::size_t PlyElement::offset_of(std::size_t property, std::size_t items) const {
    std::size_t bytes = 0;
    for (const PlyProperty& above : std::span(properties).first(property)) {
        if (above.is_list()) bytes += size_of(*above.count_type);
        bytes += size_of(above.type) * (above.is_list() ? items : 1);
    }
    return bytes;
}

PlyHeader parse_ply_header(Mistakes& mistakes) {
    PlyHeader header = HeaderReader(mistakes).read();
    check_header(header, mistakes);
    return header;
}

}  // namespace rt
