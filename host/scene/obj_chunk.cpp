// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "host/base/text.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_corner.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Statements that do not affect the picture: texture coordinates, names, hints for other programs.
constexpr std::string_view ignored_words[] = {
    "vt",       "g",      "o",      "s",          "mg",        "lod",   "bevel", "c_interp",
    "d_interp", "usemap", "maplib", "shadow_obj", "trace_obj", "stech", "ctech"};
constexpr std::string_view free_form_words[] = {
    "vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",
    "hole", "scrv",   "sp",  "end",  "con",  "bsp",  "bzp",   "cdc",  "cdp",  "res"};
constexpr std::string_view known_words[] = {"v", "vn", "vt", "f",      "g",     "o",
                                            "s", "l",  "p",  "usemtl", "mtllib"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

void require_statement_end(LineScanner& scanner, std::string_view word, Mistakes& mistakes) {
    if (!scanner.word_follows()) return;
    const std::size_t offset = scanner.offset();
    mistakes.add(offset, fmt::format("unexpected {} after the numbers of {}; remove it",
                                     in_quotes(scanner.word()), word));
}

std::optional<glm::dvec3> read_three(LineScanner& scanner, std::string_view name,
                                     Mistakes& mistakes) {
    glm::dvec3 v(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto number = read_number(scanner, name, mistakes);
        if (!number) return std::nullopt;
        v[axis] = *number;
    }
    return v;
}

void read_position(LineScanner& scanner, ObjChunk& chunk) {
    const auto position = read_three(scanner, "a coordinate", chunk.mistakes);
    chunk.positions.push_back(position.value_or(glm::dvec3(0)));
    if (!position) return;
    constexpr int most = 5;  // a weight and a color with alpha, which are not used
    for (int extra = 0; extra < most && scanner.word_follows(); ++extra) scanner.word();
    require_statement_end(scanner, "v", chunk.mistakes);
}

void read_normal(LineScanner& scanner, ObjChunk& chunk) {
    const auto normal = read_three(scanner, "a normal", chunk.mistakes);
    chunk.normals.push_back(normal.value_or(glm::dvec3(0)));
    if (normal) require_statement_end(scanner, "vn", chunk.mistakes);
}

class FaceReader {
   public:
    FaceReader(ObjChunk& chunk, ObjCounts above, const std::vector<glm::dvec3>& positions)
        : chunk_(chunk),
          above_(above),
          positions_(positions),
          clean_(chunk.mistakes.count() == 0),
          mistakes_(chunk.mistakes.part()),
          scanner_(mistakes_.text().substr(0, chunk.end), chunk.begin) {}

    void read() {
        for (; !mistakes_.is_full() && scanner_.find_word(); scanner_.next_line()) read_statement();
        chunk_.mistakes.add_all(mistakes_);
        chunk_.faces.shrink_to_fit();
        chunk_.face_normals.shrink_to_fit();
    }

   private:
    void read_statement() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        if (word == "f") return read_face(offset);
        if (word == "v") return static_cast<void>(++above_.positions);
        if (word == "vn") return static_cast<void>(++above_.normals);
        if (word == "usemtl") return read_material();
        if (word == "mtllib") return read_library();
        if (is_one_of(word, ignored_words)) return;
        if (word == "l" || word == "p") return static_cast<void>(++chunk_.left_out);
        refuse_statement(offset, word);
    }

    void read_material() {
        const std::size_t offset = scanner_.offset();
        ObjEvent& event = chunk_.events.emplace_back();
        event.faces_before = chunk_.faces.size();
        event.what = ObjMaterialUse{printable(scanner_.rest()), offset};
    }

    void read_library() {
        scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        chunk_.libraries.push_back({std::string(scanner_.rest()), offset});
    }

    void refuse_statement(std::size_t offset, std::string_view word) {
        std::string advice = suggestion(word, known_words, "known statements are");
        if (is_one_of(word, free_form_words)) {
            advice = "curves and surfaces are not supported; export polygons";
        } else if (word == "call" || word == "csh") {
            advice = "including files and running commands is not supported";
        }
        mistakes_.add(offset, fmt::format("unknown statement {}; {}", in_quotes(word), advice));
    }

    /// Converts an index from 1, or from -1 backward, to one from 0; notes an invalid one.
    std::optional<std::uint32_t> resolve(std::int64_t index, std::size_t count,
                                         std::string_view what, std::size_t offset) {
        const auto size = static_cast<std::int64_t>(count);
        const bool good = index >= -size && index <= size && index != 0;
        if (good) return static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index);
        if (index == 0) {
            mistakes_.add(offset, fmt::format("{} 0 does not exist; indices start at 1", what));
        } else {
            mistakes_.add(
                offset,
                fmt::format("{} {} does not exist, only {} defined above; correct the number", what,
                            index, count));
        }
        return std::nullopt;
    }

    std::optional<ObjCorner> take_corner(std::size_t offset) {
        ObjCorner plain;
        if (const std::size_t length = parse_plain_obj_corner(scanner_.left(), plain)) {
            scanner_.advance(length);
            return plain;
        }
        const std::string_view word = scanner_.word();
        const auto corner = parse_obj_corner(word);
        if (!corner) {
            mistakes_.add(
                offset,
                fmt::format(
                    "{} is not a face corner; write v, v/vt, v//vn or v/vt/vn in whole numbers",
                    in_quotes(word)));
        }
        return corner;
    }

    /// Appends one corner to corners_ and normals_; returns whether it is valid.
    bool read_corner() {
        const std::size_t offset = scanner_.offset();
        const auto corner = take_corner(offset);
        if (!corner) return false;
        const auto position = resolve(corner->position, above_.positions, "vertex", offset);
        if (!position) return false;
        if (!corners_.empty() && corner->has_normal == normals_.empty()) {
            mistakes_.add(
                offset, "only some corners of the face have normals; give normals to all or none");
            return false;
        }
        corners_.push_back(*position);
        if (!corner->has_normal) return true;
        const auto normal = resolve(corner->normal, above_.normals, "normal", offset);
        if (normal) normals_.push_back(*normal);
        return normal.has_value();
    }

    void read_face(std::size_t offset) {
        corners_.clear();
        normals_.clear();
        while (scanner_.word_follows()) {
            if (!read_corner()) return;
            if (corners_.size() > max_face_corners) {
                mistakes_.add(offset, fmt::format("the face has more than {} corners; split it",
                                                  max_face_corners));
                return;
            }
        }
        if (corners_.size() < 3) {
            mistakes_.add(offset, fmt::format("the face has {}; write three or more",
                                              counted(corners_.size(), "corner")));
        } else if (clean_ && mistakes_.count() == 0) {
            add_face();
        }
    }

    void add_face() {
        const auto& c = corners_;
        if (c.size() == 3) return add_triangle(0, 1, 2);
        const bool parts = c.size() == 4 && parts_well({positions_[c[0]], positions_[c[1]],
                                                        positions_[c[2]], positions_[c[3]]});
        if (parts) {
            add_triangle(0, 1, 2);
            return add_triangle(0, 2, 3);
        }
        chunk_.events.push_back({chunk_.faces.size(), ObjPolygon{corners_, normals_}});
    }

    void add_triangle(std::size_t a, std::size_t b, std::size_t c) {
        const Scene::Mesh::Face face = {corners_[a], corners_[b], corners_[c]};
        if (normals_.empty()) return append_face(face, nullptr, chunk_.faces, chunk_.face_normals);
        const Scene::Mesh::Face normals = {normals_[a], normals_[b], normals_[c]};
        append_face(face, &normals, chunk_.faces, chunk_.face_normals);
    }

    ObjChunk& chunk_;
    ObjCounts above_;
    const std::vector<glm::dvec3>& positions_;
    const bool clean_;  ///< all vertices were valid
    Mistakes mistakes_;
    LineScanner scanner_;
    std::vector<std::uint32_t> corners_, normals_;  ///< of the face being read
};

}  // namespace

void read_obj_vertices(ObjChunk& chunk) {
    LineScanner scanner(chunk.mistakes.text().substr(0, chunk.end), chunk.begin);
    for (; scanner.find_word(); scanner.next_line()) {
        const std::string_view word = scanner.word();
        if (word == "v") {
            read_position(scanner, chunk);
        } else if (word == "vn") {
            read_normal(scanner, chunk);
        }
    }
}

void read_obj_faces(ObjChunk& chunk, ObjCounts above, const std::vector<glm::dvec3>& positions) {
    FaceReader(chunk, above, positions).read();
}

}  // namespace rt
