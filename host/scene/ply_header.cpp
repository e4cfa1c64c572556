// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "host/scene/line_scanner.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Elements, or properties of one: no model has a header with more.
constexpr std::size_t max_declared = 1000;

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr TypeName type_names[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

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
        const std::string_view left = text.substr(scanner_.offset());
        if (left.empty()) return;
        const bool two = !only_returns && left.starts_with("\r\n");
        scanner_ = LineScanner(text, scanner_.offset() + (two ? 2 : 1));
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
        constexpr std::string_view known[] = {"format",  "comment",  "obj_info",
                                              "element", "property", "end_header"};
        mistakes_.add(offset_, fmt::format("unknown word {} in the header; known words are {}",
                                           in_quotes(word), word_list(known)));
    }

    void read_format() {
        constexpr std::string_view names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        const std::string_view name = scanner_.word(), version = scanner_.word();
        const auto found = std::ranges::find(names, name);
        if (found == std::end(names)) {
            mistakes_.add(offset, fmt::format("unknown format {}; known formats are {}",
                                              in_quotes(name), word_list(names)));
        } else if (version != "1.0") {
            mistakes_.add(offset, fmt::format("unknown version {} of the format; write 1.0",
                                              in_quotes(version)));
        } else if (has_format_) {
            mistakes_.add(offset_, "the format is given twice; keep one");
        } else {
            header_.format = static_cast<PlyFormat>(found - std::begin(names));
        }
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
            mistakes_.add(offset, fmt::format("the count of element {} is {}; write a whole "
                                              "number, 0 or more",
                                              in_quotes(element.name),
                                              there ? count ? fmt::format("{}", *count)
                                                            : in_quotes(scanner_.word())
                                                    : "missing"));
        } else {
            element.count = static_cast<std::uint64_t>(*count);
        }
        if (header_.find(element.name)) {
            mistakes_.add(offset_, fmt::format("element {} is declared twice; keep one",
                                               in_quotes(element.name)));
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
        const auto found = std::ranges::find(type_names, word, &TypeName::name);
        if (found != std::end(type_names)) return found->type;
        mistakes_.add(offset, fmt::format("unknown type {}; write char, uchar, short, ushort, "
                                          "int, uint, float or double",
                                          in_quotes(word)));
        return std::nullopt;
    }

    void read_property() {
        if (header_.elements.empty()) {
            mistakes_.add(offset_, "a property comes before the first element; move it below one");
            return;
        }
        PlyProperty property;
        LineScanner ahead = scanner_;
        if (ahead.word() == "list") {
            scanner_ = ahead;
            scanner_.word_follows();
            const std::size_t offset = scanner_.offset();
            property.count_type = read_type();
            if (!property.count_type) return;
            if (!is_whole(*property.count_type)) {
                mistakes_.add(offset, "a list's length must be a whole number; write uchar or int");
                return;
            }
        }
        const auto type = read_type();
        if (!type) return;
        property.type = *type;
        property.name = scanner_.word();
        add_property(std::move(property));
    }

    void add_property(PlyProperty property) {
        PlyElement& element = header_.elements.back();
        if (property.name.empty()) {
            mistakes_.add(offset_, "the property has no name; write one after its type");
        } else if (element.find(property.name)) {
            mistakes_.add(offset_, fmt::format("property {} is declared twice in element {}; "
                                               "rename one",
                                               in_quotes(property.name), in_quotes(element.name)));
        } else if (element.properties.size() >= max_declared) {
            fail(offset_, fmt::format("more than {} properties; check that this is a PLY file",
                                      max_declared));
        } else {
            element.properties.push_back(std::move(property));
        }
    }

    LineScanner scanner_;
    Mistakes& mistakes_;
    PlyHeader header_;
    std::size_t offset_ = 0;  ///< of the line being read
    bool has_format_ = false;
};

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    return found == properties.end() ? nullptr : &*found;
}

std::size_t PlyElement::least_bytes(PlyFormat format) const {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        bytes +=
            format == PlyFormat::ascii ? 2 : size_of(property.count_type.value_or(property.type));
    }
    return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    const auto found = std::ranges::find(elements, element, &PlyElement::name);
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader parse_ply_header(Mistakes& mistakes) { return HeaderReader(mistakes).read(); }

}  // namespace rt
