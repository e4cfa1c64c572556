// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "host/scene/line_scanner.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_materials.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Without effect on what we draw: texture coordinates, names, and hints for other programs.
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

/// "1", "1/2", "1//3" or "1/2/3" as the file says it, or with nothing after a slash: "1/", "1//",
/// "1/2/". 0 where there is no number, which is none that OBJ allows.
struct Corner {
    std::int64_t position = 0, texture = 0, normal = 0;
    bool has_normal = false;
};

/// Reads one number up to a slash or the end; whether it is one.
bool take_index(std::string_view& text, std::int64_t& index) {
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, index);
    if (result.ec != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return text.empty() || text[0] == '/';
}

std::optional<Corner> parse_corner(std::string_view text) {
    Corner corner;
    if (!take_index(text, corner.position)) return std::nullopt;
    if (text.empty()) return corner;
    text.remove_prefix(1);
    const bool textured = !text.empty() && text[0] != '/';
    if (textured && !take_index(text, corner.texture)) return std::nullopt;
    if (text.empty()) return corner;
    text.remove_prefix(1);
    corner.has_normal = !text.empty();
    if (text.empty()) return corner;
    if (!take_index(text, corner.normal) || !text.empty()) return std::nullopt;
    return corner;
}

class ObjReader {
   public:
    ObjReader(std::string_view text, const std::string& file_name)
        : scanner_(text), mistakes_(text, file_name), file_name_(file_name) {}

    Model read(const OpenLibrary& open) {
        for (; scanner_.find_word(); scanner_.next_line()) read_statement();
        mistakes_.throw_if_any();
        Model model;
        if (open) model = materials_.load(open, mistakes_);
        const bool no_materials = model.materials.empty() && !materials_.lacks_library();
        model.mesh = builder_.take();
        for (std::string& note : builder_.notes(file_name_)) model.notes.push_back(std::move(note));
        if (no_materials) {
            model.mesh.face_materials = {-1};
        } else {
            materials_.resolve(model, mistakes_);
            mistakes_.throw_if_any();
        }
        if (left_out_ > 0) {
            model.notes.push_back(fmt::format("{}: {} line{} of points or lines (p, l) left out",
                                              file_name_, left_out_, left_out_ == 1 ? "" : "s"));
        }
        return model;
    }

   private:
    void read_statement() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        if (word == "v") return read_position();
        if (word == "f") return read_face(offset);
        if (word == "vn") return read_normal();
        if (word == "usemtl") return builder_.use_material(materials_.use(scanner_));
        if (word == "mtllib") return materials_.note_library(scanner_);
        if (is_one_of(word, ignored_words)) return;
        if (word == "l" || word == "p") {
            ++left_out_;
            return;
        }
        refuse_statement(offset, word);
    }

    void refuse_statement(std::size_t offset, std::string_view word) {
        std::string advice = "known statements are " + listed(known_words);
        if (is_one_of(word, free_form_words)) {
            advice = "curves and surfaces cannot be drawn, export polygons";
        } else if (word == "call" || word == "csh") {
            advice = "other files and commands are not run, put their text here";
        } else if (const auto near = nearest_word(word, known_words); !near.empty()) {
            advice = fmt::format("did you mean {}?", in_quotes(near));
        }
        mistakes_.add(offset, fmt::format("unknown statement {}; {}", in_quotes(word), advice));
    }

    std::optional<glm::dvec3> read_three(std::string_view name) {
        glm::dvec3 v(0);
        for (int axis = 0; axis < 3; ++axis) {
            const auto number = read_number(scanner_, name, mistakes_);
            if (!number) return std::nullopt;
            v[axis] = *number;
        }
        return v;
    }

    /// A position that is wrong is counted all the same, so that indices keep their meaning.
    void read_position() {
        const auto position = read_three("a coordinate");
        builder_.mesh.positions.push_back(position.value_or(glm::dvec3(0)));
        if (!position) return;
        constexpr int most = 5;  // a weight and a color with alpha, which are not used
        for (int extra = 0; extra < most && scanner_.word_follows(); ++extra) scanner_.word();
        require_end("v");
    }

    void read_normal() {
        const auto normal = read_three("a normal");
        builder_.mesh.normals.push_back(normal.value_or(glm::dvec3(0)));
        if (normal) require_end("vn");
    }

    void require_end(std::string_view word) {
        if (!scanner_.word_follows()) return;
        const std::size_t offset = scanner_.offset();
        mistakes_.add(offset, fmt::format("{} follows the numbers of {}; remove it",
                                          in_quotes(scanner_.word()), word));
    }

    /// The index from 0 that an index from 1, or from -1 backwards, means; notes a wrong one.
    std::optional<std::uint32_t> resolve(std::int64_t index, std::size_t count,
                                         std::string_view what, std::size_t offset) {
        const auto size = static_cast<std::int64_t>(count);
        const bool good = index >= -size && index <= size && index != 0;
        if (good) return static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index);
        if (index == 0) {
            mistakes_.add(offset, fmt::format("{} 0 does not exist; count from 1", what));
        } else {
            mistakes_.add(offset, fmt::format("{} {} does not exist, {} of them stand above; "
                                              "correct the number",
                                              what, index, count));
        }
        return std::nullopt;
    }

    /// Puts one corner in corners_ and normals_; whether it is good.
    bool read_corner() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        const auto corner = parse_corner(word);
        if (!corner) {
            mistakes_.add(offset, fmt::format("{} is no corner of a face; write v, v/vt, v//vn or "
                                              "v/vt/vn in whole numbers",
                                              in_quotes(word)));
            return false;
        }
        const auto position =
            resolve(corner->position, builder_.mesh.positions.size(), "vertex", offset);
        if (!position) return false;
        if (!corners_.empty() && corner->has_normal == normals_.empty()) {
            mistakes_.add(offset,
                          "some corners of the face have a normal and some have none; "
                          "give all of them one, or none");
            return false;
        }
        corners_.push_back(*position);
        if (!corner->has_normal) return true;
        const auto normal = resolve(corner->normal, builder_.mesh.normals.size(), "normal", offset);
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
            mistakes_.add(offset, fmt::format("the face has {} corner{}; write three or more",
                                              corners_.size(), corners_.size() == 1 ? "" : "s"));
        } else if (mistakes_.count() == 0) {
            builder_.add_face(corners_, normals_);
        }
    }

    LineScanner scanner_;
    Mistakes mistakes_;
    std::string file_name_;
    MeshBuilder builder_;
    ObjMaterials materials_;
    std::vector<std::uint32_t> corners_, normals_;  ///< of the face being read
    std::size_t left_out_ = 0;
};

}  // namespace

Model parse_obj(std::string_view text, const std::string& file_name, const OpenLibrary& open) {
    return ObjReader(text, file_name).read(open);
}

}  // namespace rt
