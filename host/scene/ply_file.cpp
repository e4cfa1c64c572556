// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "host/scene/mesh.h"
#include "host/scene/model.h"
#include "host/scene/ply.h"
#include "host/scene/scene.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr Remedy bad_face{"face left out", "faces left out"};
constexpr Remedy bad_vertex = bad_face;
constexpr Remedy bad_strip_vertex = bad_face;
constexpr Remedy bad_normal{"normal ignored", "normals ignored"};
constexpr Remedy bad_row{"row ignored", "rows ignored"};
constexpr Remedy extra_value{"value ignored", "values ignored"};
constexpr Remedy extra_line{"line ignored", "lines ignored"};
constexpr Remedy extra_byte{"byte ignored", "bytes ignored"};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view column_names[] = {"x", "y", "z", "nx", "ny", "nz"};

bool is_within(double x) { return std::abs(x) <= max_scene_number; }

/// Reads the rows of elements value by value: of text, where each has its own line, or of bytes in
/// either order. A text row that cannot be read is noted once, and gives no more values; bytes that
/// are missing are an error.
class Rows {
   public:
    Rows(const PlyHeader& header, Mistakes& mistakes)
        : scanner_(mistakes.text(), header.data_offset),
          is_text_(header.format == PlyFormat::ascii),
          swapped_((header.format == PlyFormat::little_endian) !=
                   (std::endian::native == std::endian::little)),
          mistakes_(&mistakes) {}

    bool is_text() const { return is_text_; }
    bool swapped() const { return swapped_; }
    std::string_view left() const { return scanner_.left(); }
    std::size_t offset() const { return scanner_.offset(); }
    void advance(std::size_t bytes) { scanner_.advance(bytes); }

    void start_element(const PlyElement& element) {
        element_ = &element;
        const bool is_face = element.name == "face" || element.name == "tristrips";
        remedy_ = element.name == "vertex" ? &bad_vertex : is_face ? &bad_face : &bad_row;
    }

    /// Returns whether the file has another row.
    bool start_row(std::uint64_t row) {
        row_ = row;
        is_good_ = true;
        if (!is_text_ || scanner_.find_word()) return true;
        fail(scanner_.offset(),
             fmt::format("the file ends before {}, of {}; save the model again", row_name(),
                         element_->count),
             element_->count - row);
        return false;
    }

    void end_row() {
        if (!is_text_) return;
        if (is_good_ && scanner_.word_follows()) {
            const std::size_t offset = scanner_.offset();
            mistakes_->note(extra_value, offset, "unexpected {} after the values of {}; remove it",
                            in_quotes(scanner_.word()), row_name());
        }
        scanner_.next_line();
    }

    /// Reads a value; returns whether it could.
    bool number(PlyType type, double& value) {
        if (!is_text_) {
            const char* at = take(size_of(type));
            if (at) value = ply_number(at, type, swapped_);
            return at != nullptr;
        }
        if (!has_word()) return false;
        const auto number = scanner_.number();
        if (!number) return refuse_word("a number");
        value = *number;
        return true;
    }

    bool integer(PlyType type, std::int64_t& value) {
        if (!is_text_) {
            const char* at = take(size_of(type));
            if (at) value = ply_whole(at, type, swapped_);
            return at != nullptr;
        }
        if (!has_word()) return false;
        const auto whole = scanner_.integer();
        if (!whole) return whole_number(value);
        value = *whole;
        return true;
    }

    /// Skips this many values; returns whether they exist.
    bool skip(PlyType type, std::uint64_t count) {
        if (!is_text_) return take(size_of(type), count) != nullptr;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (!has_word()) return false;
            scanner_.word();
        }
        return true;
    }

    /// Notes what is wrong at this place; a text row may be given up.
    void note(const Remedy& remedy, std::string message, std::size_t count = 1) {
        mistakes_->note_in(is_text_ ? "" : row_name(), remedy, scanner_.offset(),
                           std::move(message), count);
    }
    void fail(std::size_t offset, std::string message, std::size_t count = 1) {
        is_good_ = false;
        mistakes_->note_in(is_text_ ? "" : row_name(), *remedy_, offset, std::move(message),
                           remedy_ == &bad_vertex ? 0 : count);
    }
    [[nodiscard]] bool is_good() const { return is_good_; }

    void refuse(std::string message) {
        mistakes_->add_in(row_name(), scanner_.offset(), std::move(message));
        mistakes_->throw_if_any();
    }

    /// Notes what follows the last row, save for a line end left by an editor or a program.
    void note_rest() {
        const char* message = "more data follows than the header declares; correct its counts";
        constexpr std::size_t few = 4;
        if (!is_text_ &&
            (left().size() > few || left().find_first_not_of("\r\n \t") != left().npos)) {
            return note(extra_byte, message, left().size());
        }
        while (is_text_ && scanner_.find_word()) {
            note(extra_line, message);
            scanner_.next_line();
        }
    }

    /// Says "element 'face' 17" (rows count from 0, as indices do).
    std::string row_name() const {
        return element_ ? fmt::format("element {} {}", in_quotes(element_->name), row_) : "end";
    }

   private:
    bool has_word() {
        if (!is_good_) return false;
        if (scanner_.word_follows()) return true;
        fail(scanner_.offset(),
             fmt::format("the line of {} ends too early; write all values of its properties and a "
                         "line for each row",
                         row_name()));
        return false;
    }

    bool refuse_word(std::string_view wanted) {
        const std::size_t offset = scanner_.offset();
        fail(offset, fmt::format("a value of {} is {}; write {}", row_name(),
                                 in_quotes(scanner_.word()), wanted));
        return false;
    }

    /// In text, "3.0" is whole too.
    bool whole_number(std::int64_t& value) {
        LineScanner ahead = scanner_;
        const auto number = ahead.number();
        if (!number || std::abs(*number) > 1e15 || *number != std::floor(*number)) {
            return refuse_word("a whole number");
        }
        scanner_ = ahead;
        value = static_cast<std::int64_t>(*number);
        return true;
    }

    const char* take(std::size_t bytes, std::uint64_t count = 1) {
        const std::string_view all = left();
        if (all.size() / bytes < count) {
            refuse("the file ends before it does; save the model again");
            return nullptr;
        }
        advance(bytes * count);
        return all.data();
    }

    LineScanner scanner_;
    bool is_text_, swapped_;
    Mistakes* mistakes_;
    const PlyElement* element_ = nullptr;
    std::uint64_t row_ = 0;
    const Remedy* remedy_ = nullptr;  ///< for rows that cannot be read
    bool is_good_ = true;             ///< nothing was wrong with the current row
};

class BodyReader {
   public:
    BodyReader(const PlyHeader& header, Mistakes& mistakes, const ReadPace& pace)
        : header_(header), rows_(header, mistakes), mistakes_(mistakes), pace_(pace) {}

    /// Faces above the vertices are skipped, and read after them.
    Model read() {
        std::vector<std::pair<const PlyElement*, Rows>> waiting;
        bool has_vertices = false;
        for (const PlyElement& element : header_.elements) {
            check_count(element);
            if (element.properties.empty()) continue;
            const bool is_face = element.name == "face", is_strip = element.name == "tristrips";
            if (element.name == "vertex") {
                has_vertices = true;
                read_vertices(element);
            } else if ((is_face || is_strip) && has_vertices) {
                is_face ? read_faces(element) : read_strips(element);
            } else {
                if (is_face || is_strip) waiting.emplace_back(&element, rows_);
                read_rows(element, [&] { skip_all(element); });
            }
        }
        rows_.note_rest();
        for (const auto& [element, rows] : waiting) {
            rows_ = rows;
            element->name == "face" ? read_faces(*element) : read_strips(*element);
        }
        return finish();
    }

   private:
    Model finish() {
        Model model;
        model.mesh = builder_.take();
        model.mesh.face_materials = {-1};
        if (model.mesh.faces.empty()) mistakes_.refuse_notes();
        for (glm::dvec3& p : model.mesh.positions) {
            if (!all_readable_ && std::isnan(p.x)) p = glm::dvec3(0);  // no face uses it
        }
        if (!model.mesh.normals.empty()) model.mesh.face_normals = model.mesh.faces;
        model.notes = mistakes_.notes();
        std::ranges::move(builder_.notes(mistakes_.file_name()), std::back_inserter(model.notes));
        return model;
    }

    /// Checks a declared row count against the bytes that are left; faces at the end of a text may
    /// be missing.
    void check_count(const PlyElement& element) {
        if (rows_.is_text() && element.name != "vertex") return;
        const std::size_t least = element.least_bytes(header_.format);
        if (least == 0) return;
        const std::uint64_t most = (rows_.left().size() + 1) / least;
        if (element.count <= most) return;
        mistakes_.add(element.offset,
                      "element {} declares {} rows, but the rest of the file holds at most {}; "
                      "correct the count or save the model again",
                      in_quotes(element.name), element.count, most);
        mistakes_.throw_if_any();
    }

    template <typename ReadRow>
    void read_rows(const PlyElement& element, ReadRow read_row) {
        rows_.start_element(element);
        for (std::uint64_t row = 0; row < element.count && rows_.start_row(row); ++row) {
            read_row();
            rows_.end_row();
        }
    }

    /// Reads the length of a list. A negative one gives up a row of text, but it cannot be known
    /// where the next row of bytes begins.
    bool list_length(const PlyProperty& list, std::uint64_t& length) {
        const std::size_t offset = rows_.offset();
        std::int64_t number = 0;
        if (!rows_.integer(*list.count_type, number)) return false;
        length = static_cast<std::uint64_t>(number);
        if (number >= 0) return true;
        std::string message = fmt::format("the length of list {} is {}; write 0 or more",
                                          in_quotes(list.name), number);
        if (!rows_.is_text() && !rows_.left().empty()) rows_.refuse(message);
        rows_.fail(offset, std::move(message));
        return false;
    }

    void skip(const PlyProperty& property) {
        std::uint64_t length = 1;
        if (!property.is_list() || list_length(property, length)) {
            rows_.skip(property.type, length);
        }
    }

    void skip_all(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) skip(property);
    }

    void read_vertices(const PlyElement& element) {
        std::array<std::size_t, 6> places{};
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = element.find(column_names[i]);
        const bool smooth = std::all_of(places.begin() + 3, places.end(), [&](std::size_t place) {
            return place < element.properties.size() && !element.properties[place].is_list();
        });
        Scene::Mesh& mesh = builder_.mesh;
        const auto bytes = rows_.is_text() ? std::nullopt : fixed_rows(rows_.left(), element);
        if (bytes) {
            read_blocks(*bytes, element, places, smooth);
            return;
        }
        mesh.positions.reserve(element.count);
        if (smooth) mesh.normals.reserve(element.count);
        std::vector<std::size_t> columns;  // of the properties; 6 for those that are not used
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            columns.push_back(
                static_cast<std::size_t>(std::ranges::find(places, i) - places.begin()));
        }
        read_rows(element, [&] {
            std::array<double, 6> v{nan, nan, nan, nan, nan, nan};
            for (std::size_t i = 0; i < columns.size(); ++i) {
                if (columns[i] == v.size()) {
                    skip(element.properties[i]);
                } else {
                    rows_.number(element.properties[i].type, v[columns[i]]);
                }
            }
            mesh.positions.push_back(checked({v[0], v[1], v[2]}, 0));
            if (smooth) mesh.normals.push_back(checked({v[3], v[4], v[5]}, 3));
        });
    }

    void read_blocks(std::string_view bytes, const PlyElement& element,
                     const std::array<std::size_t, 6>& places, bool smooth) {
        Scene::Mesh& mesh = builder_.mesh;
        rows_.start_element(element);
        const auto read = [&](std::size_t first, std::vector<glm::dvec3>& target) {
            const bool good =
                read_columns(bytes, element, {places[first], places[first + 1], places[first + 2]},
                             rows_.swapped(), target, pace_);
            for (std::size_t i = 0; !good && i < target.size(); ++i) {
                rows_.start_row(i);
                target[i] = checked(target[i], first);
            }
        };
        read(0, mesh.positions);
        if (smooth) read(3, mesh.normals);
        rows_.advance(bytes.size());
    }

    /// The vector of the row at hand, whose columns start with `first`; NaN, or for a normal 0,
    /// where a number is not within the limit, with a note.
    glm::dvec3 checked(const glm::dvec3& v, std::size_t first) {
        for (int axis = 0; axis < 3; ++axis) {
            if (is_within(v[axis])) continue;
            const bool is_normal = first > 0;
            if (!is_normal) all_readable_ = false;
            if (rows_.is_good()) {
                rows_.note(
                    is_normal ? bad_normal : bad_vertex,
                    fmt::format("{} is {}; write a number from -1e30 to 1e30",
                                in_quotes(column_names[first + static_cast<std::size_t>(axis)]),
                                v[axis]),
                    is_normal ? 1 : 0);
            }
            return is_normal ? glm::dvec3(0) : glm::dvec3(nan);
        }
        return v;
    }

    bool read_faces_side_by_side(const PlyElement& element) {
        if (rows_.is_text() || !all_readable_) return false;
        auto block =
            read_face_block(rows_.left(), element, rows_.swapped(), builder_.mesh.positions, pace_);
        if (!block) return false;
        if (builder_.mesh.faces.empty()) {
            builder_.mesh.faces = std::move(block->faces);
        } else {
            builder_.add_triangles(block->faces, {});
        }
        rows_.advance(block->bytes);
        return true;
    }

    void read_faces(const PlyElement& element) {
        if (read_faces_side_by_side(element)) return;
        constexpr std::uint64_t triangle_bytes = 8;  // "3 0 1 2\n"; usual binary rows take more
        builder_.mesh.faces.reserve(std::min(element.count, rows_.left().size() / triangle_bytes));
        const std::size_t list = element.find_corners();
        read_rows(element, [&] {
            bool good = true;
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                const PlyProperty& property = element.properties[i];
                i == list ? static_cast<void>(good = read_corners(property)) : skip(property);
            }
            if (good && rows_.is_good()) builder_.add_face(corners_, {});
        });
    }

    /// Reads a face's list to its end; returns whether it is a face.
    bool read_corners(const PlyProperty& list) {
        std::uint64_t length = 0;
        if (!list_length(list, length)) return false;
        if (length < 3 || length > max_face_corners) {
            rows_.fail(rows_.offset(), fmt::format("the face has {} corners; use 3 to {}", length,
                                                   max_face_corners));
            rows_.skip(list.type, length);
            return false;
        }
        corners_.clear();
        bool good = true;
        for (std::uint64_t i = 0; i < length; ++i) {
            std::int64_t index = 0;
            if (!rows_.integer(list.type, index)) return false;
            if (good) good = take_corner(index, bad_face, 1);
        }
        return good;
    }

    /// Appends a vertex to corners_ if it exists and can be read; notes it otherwise.
    bool take_corner(std::int64_t index, const Remedy& remedy, std::size_t count) {
        const std::vector<glm::dvec3>& all = builder_.mesh.positions;
        if (index < 0 || static_cast<std::uint64_t>(index) >= all.size()) {
            rows_.note(
                remedy,
                fmt::format("vertex {} does not exist, there are {}, counted from 0; correct "
                            "the number",
                            index, all.size()),
                count);
            return false;
        }
        corners_.push_back(static_cast<std::uint32_t>(index));
        if (all_readable_ || !std::isnan(all[corners_.back()].x)) return true;
        count > 0 ? rows_.note(bad_vertex, {})
                  : rows_.note(remedy, "a vertex of the strip cannot be read", 0);
        return false;
    }

    void read_strips(const PlyElement& element) {
        const std::size_t list = element.find_corners();
        read_rows(element, [&] {
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                const PlyProperty& property = element.properties[i];
                i == list ? read_strip(property) : skip(property);
            }
        });
    }

    /// Triangles of three consecutive vertices, with alternating winding. -1 starts a new strip.
    /// Triangles with a repeated vertex are skipped; a bad vertex takes three triangles with it.
    void read_strip(const PlyProperty& list) {
        std::uint64_t length = 0;
        if (!list_length(list, length)) return;
        std::size_t seen = 0, good = 0;  // in this strip; good ones in a row
        for (std::uint64_t i = 0; i < length; ++i) {
            std::int64_t index = 0;
            if (!rows_.integer(list.type, index)) return;
            if (index == -1) {
                seen = good = 0;
                continue;
            }
            if (good == 0) corners_.clear();
            good = take_corner(index, bad_strip_vertex, 0) ? good + 1 : 0;
            if (++seen < 3) continue;
            if (good >= 3) {
                add_strip_triangle(seen % 2 == 0);
            } else {
                rows_.note(bad_strip_vertex, {});
            }
        }
    }

    void add_strip_triangle(bool turned) {
        const auto last = std::span(corners_).last(3);
        const auto [a, b, c] = std::array{last[0], last[1], last[2]};
        if (a == b || b == c || c == a) return;
        builder_.add_face(turned ? std::array{b, a, c} : std::array{a, b, c}, {});
    }

    const PlyHeader& header_;
    Rows rows_;
    Mistakes& mistakes_;
    ReadPace pace_;
    MeshBuilder builder_;
    std::vector<std::uint32_t> corners_;  ///< of the face or strip being read
    bool all_readable_ = true;            ///< no position is NaN
};

}  // namespace

Model parse_ply(std::string_view text, const std::string& file_name, const ReadPace& pace) {
    Mistakes mistakes(text, file_name);
    const PlyHeader header = parse_ply_header(mistakes);
    return BodyReader(header, mistakes, pace).read();
}

}  // namespace rt
