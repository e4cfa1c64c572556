// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "host/scene/mesh.h"
#include "host/scene/model.h"
#include "host/scene/ply.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr Remedy bad_ply_face{"face left out", "faces left out"};
constexpr Remedy bad_ply_vertex = bad_ply_face;
constexpr Remedy bad_strip_vertex{"strip cut", "strips cut"};
constexpr Remedy bad_ply_normal{"normal ignored", "normals ignored"};
constexpr Remedy bad_row{"row ignored", "rows ignored"};
constexpr Remedy extra_value{"value ignored", "values ignored"};
constexpr Remedy extra_data{"end ignored", "ends ignored"};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view column_names[] = {"x", "y", "z", "nx", "ny", "nz"};

using Vectors = std::vector<glm::dvec3>;
using Places = std::array<std::size_t, 6>;  ///< of properties in an element

/// Reads a number from bytes, byte-swapped if `swapped`.
template <typename T>
T ply_bytes(const char* at, bool swapped) {
    std::array<unsigned char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

double ply_number(const char* at, PlyType type, bool swapped) {
    switch (type) {
        case PlyType::int8:
            return static_cast<std::int8_t>(*at);
        case PlyType::uint8:
            return static_cast<std::uint8_t>(*at);
        case PlyType::int16:
            return ply_bytes<std::int16_t>(at, swapped);
        case PlyType::uint16:
            return ply_bytes<std::uint16_t>(at, swapped);
        case PlyType::int32:
            return ply_bytes<std::int32_t>(at, swapped);
        case PlyType::uint32:
            return ply_bytes<std::uint32_t>(at, swapped);
        case PlyType::float32:
            return ply_bytes<float>(at, swapped);
        case PlyType::float64:
            break;
    }
    return ply_bytes<double>(at, swapped);
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

/// Reads the N corners of a list; returns whether it has so many, and all exist. `usual` lists have
/// a count byte, then 32-bit indices.
template <std::size_t N>
bool read_corners(const char* at, const PlyProperty& list, bool usual, bool swapped,
                  std::size_t vertices, std::array<std::uint32_t, N>& corners) {
    bool good = true;
    if (usual) {
        std::memcpy(corners.data(), at + 1, sizeof corners);
        good = *at == N;
        for (std::uint32_t& corner : corners) {
            if (swapped) corner = __builtin_bswap32(corner);
            good &= corner < vertices;
        }
        return good;
    }
    if (ply_number(at, *list.count_type, swapped) != N) return false;
    at += size_of(*list.count_type);
    for (std::uint32_t& corner : corners) {
        const double index = ply_number(at, list.type, swapped);
        at += size_of(list.type);
        good &= index >= 0 && index < static_cast<double>(vertices);
        corner = static_cast<std::uint32_t>(static_cast<std::int64_t>(index));
    }
    return good;
}

/// Reads the rows of elements one by one: of text, where each has its own line, or of bytes in
/// either order. A text row that cannot be read is noted; bytes that are missing are an error.
class Rows {
   public:
    Rows(const PlyHeader& header, Mistakes& mistakes)
        : scanner_(mistakes.text(), header.data_offset),
          is_text_(header.format == PlyFormat::ascii),
          swapped_((header.format == PlyFormat::little_endian) !=
                   (std::endian::native == std::endian::little)),
          mistakes_(mistakes) {}

    bool is_text() const { return is_text_; }
    bool swapped() const { return swapped_; }
    std::string_view left() const { return scanner_.left(); }
    void advance(std::size_t bytes) { scanner_.advance(bytes); }

    /// Only the values of `wanted` properties are kept.
    void start_element(const PlyElement& element, std::span<const std::size_t> wanted) {
        element_ = &element;
        const bool is_face = element.name == "face" || element.name == "tristrips";
        remedy_ = element.name == "vertex" ? &bad_ply_vertex : is_face ? &bad_ply_face : &bad_row;
        wanted_.assign(element.properties.size(), 0);
        for (const std::size_t i : wanted) {
            if (i < wanted_.size()) wanted_[i] = 1;
        }
        firsts_.resize(wanted_.size() + 1);
    }

    /// For messages about rows that are read another way.
    void set_row(std::uint64_t row) {
        row_ = row;
        is_good_ = true;
    }

    /// Returns whether the file has this row; is_good says whether all values could be read.
    bool read(std::uint64_t row) {
        set_row(row);
        values_.clear();
        if (is_text_ && !scanner_.find_word()) {
            fail(fmt::format("the file ends before {}, of {}; save the model again", row_name(),
                             element_->count),
                 element_->count - row);
            return false;
        }
        start_ = scanner_.offset();
        for (std::size_t i = 0; is_good_ && i < wanted_.size(); ++i) {
            firsts_[i] = values_.size();
            read_property(element_->properties[i], wanted_[i] != 0);
        }
        firsts_.back() = values_.size();
        if (is_text_) end_line();
        return true;
    }

    [[nodiscard]] bool is_good() const { return is_good_; }
    /// What was read of a property: one value, or the items of a list.
    std::span<const double> values(std::size_t property) const {
        return std::span(values_).subspan(firsts_[property],
                                          firsts_[property + 1] - firsts_[property]);
    }
    double value(std::size_t property) const { return values_[firsts_[property]]; }

    /// Notes what is wrong with the row at hand.
    void note(const Remedy& remedy, std::string message, std::size_t count = 1) {
        mistakes_.report(&remedy, start_, std::move(message), count, is_text_ ? "" : row_name());
    }

    /// Notes what follows the last row.
    void note_rest() {
        if (left().find_first_not_of("\r\n \t") == left().npos) return;
        start_ = scanner_.offset();
        element_ = nullptr;
        note(extra_data, "more data follows than the header declares; correct its counts");
    }

   private:
    /// Says "element 'face' 17" (rows count from 0, as indices do).
    std::string row_name() const {
        return element_ ? fmt::format("element {} {}", in_quotes(element_->name), row_) : "end";
    }

    /// Gives the row up.
    void fail(std::string message, std::size_t count = 1) {
        is_good_ = false;
        mistakes_.report(remedy_, scanner_.offset(), std::move(message),
                         remedy_ == &bad_ply_vertex ? 0 : count, is_text_ ? "" : row_name());
    }

    void refuse(std::string message) {
        mistakes_.report(nullptr, scanner_.offset(), std::move(message), 1, row_name());
        mistakes_.throw_if_any();
    }

    void read_property(const PlyProperty& property, bool is_wanted) {
        if (!property.is_list()) return read_values(property.type, 1, is_wanted);
        read_values(*property.count_type, 1, true);
        if (!is_good_) return;
        const double length = values_.back();
        values_.pop_back();
        constexpr double most = 1e15;
        if (length >= 0 && length <= most && length == std::floor(length)) {
            return read_values(property.type, static_cast<std::uint64_t>(length), is_wanted);
        }
        std::string message = fmt::format("the length of list {} is {}; write a whole number",
                                          in_quotes(property.name), length);
        // Of bytes, it is not known where the next row begins.
        if (!is_text_ && !left().empty()) refuse(message);
        fail(std::move(message));
    }

    void read_values(PlyType type, std::uint64_t count, bool is_wanted) {
        if (is_text_) return read_words(type, count, is_wanted);
        const std::size_t size = size_of(type);
        const char* at = left().data();
        if (left().size() / size < count)
            refuse("the file ends before it does; save the model again");
        for (std::uint64_t i = 0; is_wanted && i < count; ++i, at += size) {
            values_.push_back(ply_number(at, type, swapped_));
        }
        advance(size * count);
    }

    void read_words(PlyType type, std::uint64_t count, bool is_wanted) {
        for (std::uint64_t i = 0; i < count; ++i) {
            if (!scanner_.word_follows()) {
                return fail(
                    fmt::format("the line of {} ends too early; write all values of its "
                                "properties and a line for each row",
                                row_name()));
            }
            if (!is_wanted) {
                scanner_.word();
            } else if (const auto whole = is_whole(type) ? scanner_.integer() : std::nullopt) {
                values_.push_back(static_cast<double>(*whole));
            } else if (const auto number = scanner_.number(true)) {
                values_.push_back(*number);
            } else {
                return fail(fmt::format("a value of {} is {}; write a number", row_name(),
                                        in_quotes(LineScanner(scanner_).word())));
            }
        }
    }

    void end_line() {
        if (is_good_ && scanner_.word_follows()) {
            const std::size_t offset = scanner_.offset();
            mistakes_.note(extra_value, offset, "unexpected {} after the values of {}; remove it",
                           in_quotes(scanner_.word()), row_name());
        }
        scanner_.next_line();
    }

    LineScanner scanner_;
    bool is_text_, swapped_;
    Mistakes& mistakes_;
    const PlyElement* element_ = nullptr;
    const Remedy* remedy_ = nullptr;  ///< for rows that cannot be read
    std::vector<char> wanted_;
    std::uint64_t row_ = 0;
    std::size_t start_ = 0;            ///< of the row at hand
    bool is_good_ = true;              ///< nothing was wrong with it
    std::vector<double> values_;       ///< of it
    std::vector<std::size_t> firsts_;  ///< where the values of each property begin
};

class BodyReader {
   public:
    BodyReader(const PlyHeader& header, Mistakes& mistakes, const ReadPace& pace)
        : header_(header), rows_(header, mistakes), mistakes_(mistakes), pace_(pace) {}

    Model read() {
        for (const PlyElement& element : header_.elements) {
            check_count(element);
            if (element.properties.empty()) continue;
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face" || element.name == "tristrips") {
                read_shapes(element);
            } else {
                read_rows(element, {}, [] {});
            }
        }
        rows_.note_rest();
        return finish();
    }

   private:
    Model finish() {
        Model model;
        model.mesh = std::move(mesh_);
        model.mesh.face_materials = {-1};
        if (model.mesh.faces.empty()) mistakes_.refuse_notes();
        for (glm::dvec3& p : model.mesh.positions) {
            if (!all_readable_ && std::isnan(p.x)) p = glm::dvec3(0);  // no face uses it
        }
        if (!normals_.empty()) model.mesh.face_normals = model.mesh.faces;
        model.mesh.normals = std::move(normals_);
        model.notes = mistakes_.notes();
        return model;
    }

    /// Checks a declared row count against the bytes that are left; faces at the end of a text may
    /// be missing.
    void check_count(const PlyElement& element) {
        const std::size_t least =
            rows_.is_text() ? 2 * element.properties.size() : element.row_bytes(0);
        if (least == 0 || (rows_.is_text() && element.name != "vertex")) return;
        const std::uint64_t most = (rows_.left().size() + 1) / least;
        if (element.count <= most) return;
        mistakes_.add(
            element.offset,
            "element {} declares {} rows, but the rest of the file holds at most {}; correct the "
            "count or save the model again",
            in_quotes(element.name), element.count, most);
        mistakes_.throw_if_any();
    }

    template <typename UseRow>
    void read_rows(const PlyElement& element, std::span<const std::size_t> wanted, UseRow use_row) {
        rows_.start_element(element, wanted);
        for (std::uint64_t row = 0; row < element.count && rows_.read(row); ++row) use_row();
    }

    void read_vertices(const PlyElement& element) {
        Places places{};
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = element.find(column_names[i]);
        const bool smooth = std::all_of(places.begin() + 3, places.end(), [&](std::size_t place) {
            return place < element.properties.size() && !element.properties[place].is_list();
        });
        const std::span<const std::size_t> wanted(places.data(), smooth ? 6 : 3);
        Vectors& positions = mesh_.positions;
        const std::size_t bytes = element.count * element.row_bytes(0);
        if (!rows_.is_text() && element.list_count() == 0 && bytes <= rows_.left().size()) {
            rows_.start_element(element, wanted);
            read_columns(element, places, 0, positions);
            if (smooth) read_columns(element, places, 3, normals_);
            return rows_.advance(bytes);
        }
        positions.reserve(element.count);
        if (smooth) normals_.reserve(element.count);
        read_rows(element, wanted, [&] {
            const auto vector = [&](std::size_t first) {
                if (!rows_.is_good()) return glm::dvec3(nan);
                return glm::dvec3(rows_.value(places[first]), rows_.value(places[first + 1]),
                                  rows_.value(places[first + 2]));
            };
            positions.push_back(checked(vector(0), 0));
            if (smooth) normals_.push_back(checked(vector(3), 3));
        });
    }

    /// Reads three columns, from the one with this number on, of an element without lists: in
    /// parallel, since its rows all have the same length.
    void read_columns(const PlyElement& element, const Places& places, std::size_t column,
                      Vectors& target) {
        std::array<PlyType, 3> types{};
        std::array<std::size_t, 3> offsets{};
        const bool swapped = rows_.swapped();
        bool usual = !swapped;  // three floats in a row, read without branching on their types
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t place = places[column + axis];
            types[axis] = element.properties[place].type;
            offsets[axis] = element.offset_of(place, 0);
            usual &= types[axis] == PlyType::float32 && offsets[axis] == offsets[0] + 4 * axis;
        }
        const char* const data = rows_.left().data();
        const std::size_t stride = element.row_bytes(0);
        target.resize(element.count);
        const bool good = all_rows(target.size(), stride, pace_, [&](std::size_t i) {
            const char* row = data + i * stride;
            if (usual) {
                std::array<float, 3> v;
                std::memcpy(v.data(), row + offsets[0], sizeof v);
                target[i] = glm::dvec3(v[0], v[1], v[2]);
            } else {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    target[i][static_cast<int>(axis)] =
                        ply_number(row + offsets[axis], types[axis], swapped);
                }
            }
            return is_within(target[i]);
        });
        for (std::size_t i = 0; !good && i < target.size(); ++i) {
            rows_.set_row(i);
            target[i] = checked(target[i], column);
        }
    }

    /// The vector of the row at hand, whose columns start with `first`; NaN, or for a normal 0,
    /// where a number is not within the limit, with a note.
    glm::dvec3 checked(const glm::dvec3& v, std::size_t first) {
        const bool is_normal = first > 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double number = v[static_cast<int>(axis)];
            if (std::abs(number) <= max_scene_number) continue;
            if (rows_.is_good()) {
                rows_.note(is_normal ? bad_ply_normal : bad_ply_vertex,
                           fmt::format("{} is {}; write a number from -1e30 to 1e30",
                                       in_quotes(column_names[first + axis]), number),
                           is_normal ? 1 : 0);
            }
            if (!is_normal) all_readable_ = false;
            return is_normal ? glm::dvec3(0) : glm::dvec3(nan);
        }
        return v;
    }

    void read_shapes(const PlyElement& element) {
        const std::size_t list[] = {element.find_corners()};
        if (element.name == "tristrips") {
            return read_rows(element, list, [&] {
                if (rows_.is_good()) add_strip(rows_.values(list[0]));
            });
        }
        if (!rows_.is_text() && all_readable_ && read_face_block(element)) return;
        constexpr std::uint64_t triangle_bytes = 8;  // "3 0 1 2\n"; usual binary rows take more
        mesh_.faces.reserve(std::min(element.count, rows_.left().size() / triangle_bytes));
        read_rows(element, list, [&] {
            if (rows_.is_good()) add_face(rows_.values(list[0]));
        });
    }

    /// Reads faces that are all triangles, or all quadrilaterals that pass parts_well, in parallel;
    /// a row must have one list. Returns false for all others: their rows are read one by one.
    bool read_face_block(const PlyElement& element) {
        const std::string_view data = rows_.left();
        const bool swapped = rows_.swapped();
        const std::size_t place = element.find_corners(), start = element.offset_of(place, 0);
        if (element.list_count() != 1 || element.count == 0 || data.size() < element.row_bytes(0)) {
            return false;
        }
        const PlyProperty& list = element.properties[place];
        const double corners = ply_number(data.data() + start, *list.count_type, swapped);
        if (corners != 3 && corners != 4) return false;
        const std::size_t stride = element.row_bytes(corners == 3 ? 3 : 4);
        if (data.size() / stride < element.count) return false;
        const bool usual = size_of(*list.count_type) == 1 && size_of(list.type) == 4;
        const Vectors& p = mesh_.positions;
        std::vector<Scene::Mesh::Face>& faces = mesh_.faces;
        const std::size_t first = faces.size();
        faces.resize(first + element.count * (corners == 3 ? 1 : 2));
        const auto read_row = [&](std::size_t i) {
            const char* at = data.data() + i * stride + start;
            if (corners == 3) {
                return read_corners<3>(at, list, usual, swapped, p.size(), faces[first + i]);
            }
            std::array<std::uint32_t, 4> c{};
            if (!read_corners<4>(at, list, usual, swapped, p.size(), c)) return false;
            faces[first + 2 * i] = {c[0], c[1], c[2]};
            faces[first + 2 * i + 1] = {c[0], c[2], c[3]};
            return parts_well({p[c[0]], p[c[1]], p[c[2]], p[c[3]]});
        };
        if (!all_rows(element.count, stride, pace_, read_row)) {
            faces.resize(first);
            return false;
        }
        rows_.advance(element.count * stride);
        return true;
    }

    void add_face(std::span<const double> indices) {
        if (indices.size() < 3 || indices.size() > max_face_corners) {
            return rows_.note(bad_ply_face, fmt::format("the face has {} corners; use 3 to {}",
                                                        indices.size(), max_face_corners));
        }
        corners_.clear();
        for (const double index : indices) {
            if (!take_corner(index, bad_ply_face)) return;
        }
        const auto* blemish = append_face(corners_, {}, mesh_.positions, mistakes_.text().size(),
                                          mesh_.faces, nullptr);
        if (blemish) rows_.note(blemish->remedy, blemish->message);
    }

    /// Appends a vertex to corners_ if it exists and can be read; notes it otherwise.
    bool take_corner(double index, const Remedy& remedy) {
        const Vectors& all = mesh_.positions;
        if (!(index >= 0 && index < static_cast<double>(all.size())) ||
            index != std::floor(index)) {
            rows_.note(remedy, fmt::format("vertex {} does not exist, there are {}, counted from "
                                           "0; correct the number",
                                           index, all.size()));
            return false;
        }
        corners_.push_back(static_cast<std::uint32_t>(index));
        if (all_readable_ || !std::isnan(all[corners_.back()].x)) return true;
        rows_.note(bad_ply_vertex, {});
        return false;
    }

    /// Triangles of three consecutive vertices, with alternating winding. -1 starts a new strip,
    /// as does a bad vertex. Triangles with a repeated vertex are skipped.
    void add_strip(std::span<const double> indices) {
        corners_.clear();
        for (const double index : indices) {
            if (index == -1 || !take_corner(index, bad_strip_vertex)) {
                corners_.clear();
            } else if (const std::size_t seen = corners_.size(); seen >= 3) {
                const std::uint32_t a = corners_[seen - 3], b = corners_[seen - 2];
                const std::uint32_t c = corners_[seen - 1];
                if (a == b || b == c || c == a) continue;
                mesh_.faces.push_back(seen % 2 == 0 ? std::array{b, a, c} : std::array{a, b, c});
            }
        }
    }

    const PlyHeader& header_;
    Rows rows_;
    Mistakes& mistakes_;
    ReadPace pace_;
    Scene::Mesh mesh_;
    Vectors normals_;                     ///< of the vertices, whose numbers they have
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
