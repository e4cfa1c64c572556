// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "host/base/text.h"
#include "host/scene/mesh.h"
#include "host/scene/mistakes.h"
#include "host/scene/model.h"
#include "host/scene/mtl_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

using Face = Scene::Mesh::Face;
using Positions = std::vector<glm::dvec3>;

constexpr Remedy bad_face{"face left out", "faces left out"};
constexpr Remedy bad_vertex = bad_face;
constexpr Remedy bad_corner_normal{"face made flat", "faces made flat"};
constexpr Remedy bad_normal = bad_corner_normal;
constexpr Remedy obj_ignored{"statement ignored", "statements ignored"};
constexpr Remedy not_drawn = obj_ignored;

/// Statements that do not affect the picture: texture coordinates, names, hints for other programs.
constexpr std::string_view ignored_words[] = {
    "vt",       "g",      "o",      "s",          "mg",        "lod",   "bevel", "c_interp",
    "d_interp", "usemap", "maplib", "shadow_obj", "trace_obj", "stech", "ctech"};
constexpr std::string_view known_words[] = {"v", "vn", "vt", "f",      "g",     "o",
                                            "s", "l",  "p",  "usemtl", "mtllib"};

/// A usemtl, and the number of triangles above it in its chunk.
struct MaterialStart {
    std::size_t faces_before = 0;
    ObjMaterials::Use material;
};

/// The number of vertices defined above a statement.
struct Counts {
    std::size_t positions = 0, normals = 0;
};

/// A chunk of lines of an OBJ, read in two passes, so that faces are read when all vertices are
/// known.
struct Chunk {
    Mistakes notes;
    std::size_t begin = 0, end = 0;  ///< offsets in the text

    Positions positions, normals;  ///< NaN where they cannot be read
    std::vector<Face> faces;
    std::vector<Face> face_normals;  ///< one for each face, if the file has normals
    std::vector<MaterialStart> materials;
    std::vector<ObjMaterials::Use> libraries;
};

/// Why a vector cannot be read is kept for faces that use it.
glm::dvec3 read_three(LineScanner& scanner, std::string_view name, const Remedy& remedy,
                      Mistakes& notes) {
    glm::dvec3 v(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto number = scan_number(scanner, name, notes, &remedy, 0);
        if (!number) return glm::dvec3(std::numeric_limits<double>::quiet_NaN());
        v[axis] = *number;
    }
    return v;
}

/// The first pass. What follows the three numbers, such as a color, is obj_ignored.
void read_vertices(Chunk& chunk) {
    LineScanner scanner(chunk.notes.text().substr(0, chunk.end), chunk.begin);
    for (; scanner.find_word(); scanner.next_line()) {
        const std::string_view word = scanner.word();
        if (word == "v") {
            chunk.positions.push_back(read_three(scanner, "a coordinate", bad_vertex, chunk.notes));
        } else if (word == "vn") {
            chunk.normals.push_back(read_three(scanner, "a normal", bad_normal, chunk.notes));
        } else if ((word == "usemtl" || word == "mtllib") && scanner.word_follows()) {
            scanner.rest();  // as the second pass: a backslash at its end belongs to the name
        }
    }
}

/// "1", "1/2", "1//3" or "1/2/3" as the file says it, or with nothing after a slash: "1/", "1//",
/// "1/2/". A normal that is no number is 0, which no index is.
struct Corner {
    std::int64_t position = 0, normal = 0;
    bool has_normal = false;
    std::size_t offset = 0;
};

/// Reads up to 9 digits.
std::int64_t take_digits(const char*& at, const char* end) {
    const char* const stop = end - at > 9 ? at + 9 : end;
    std::int64_t number = 0;
    for (; at != stop && *at >= '0' && *at <= '9'; ++at) number = 10 * number + (*at - '0');
    return number;
}

bool take_slash(const char*& at, const char* end) {
    if (at == end || *at != '/') return false;
    ++at;
    return true;
}

/// A fast path for the corner at the start of a line, if it consists of short positive numbers, as
/// nearly all do: returns its length, or 0 where parse_corner must parse it.
std::size_t parse_plain_corner(std::string_view line, Corner& corner) {
    const char* at = line.data();
    const char* const end = at + line.size();
    corner = {take_digits(at, end)};
    if (corner.position != 0 && take_slash(at, end)) {
        take_digits(at, end);
        corner.has_normal = take_slash(at, end);
        if (corner.has_normal) corner.normal = take_digits(at, end);
    }
    const bool ended = at != end && (*at == ' ' || *at == '\n') && at[-1] != '/';
    return ended && corner.position != 0 ? static_cast<std::size_t>(at - line.data()) : 0;
}

bool parse_corner(std::string_view text, Corner& corner) {
    const char* const end = text.data() + text.size();
    corner = {};
    const auto result = std::from_chars(text.data(), end, corner.position);
    if (result.ec != std::errc() || (result.ptr != end && *result.ptr != '/')) return false;
    const char* slash = std::find(result.ptr, end, '/');
    if (slash != end) slash = std::find(slash + 1, end, '/');
    corner.has_normal = end - slash > 1;
    if (!corner.has_normal) return true;
    const auto normal = std::from_chars(slash + 1, end, corner.normal);
    if (normal.ec != std::errc() || normal.ptr != end) corner.normal = 0;
    return true;
}

/// The second pass: all other statements.
class FaceReader {
   public:
    /// `above` counts the vertices in earlier chunks; `positions` and `normals` hold all of the
    /// file's.
    FaceReader(Chunk& chunk, Counts above, const Positions& positions, const Positions& normals,
               bool all_readable)
        : chunk_(chunk),
          notes_(chunk.notes),
          above_(above),
          positions_(positions),
          all_normals_(normals),
          all_readable_(all_readable),
          scanner_(notes_.text().substr(0, chunk.end), chunk.begin) {}

    void read() {
        for (; scanner_.find_word(); scanner_.next_line()) read_statement();
        chunk_.faces.shrink_to_fit();
        chunk_.face_normals.shrink_to_fit();
    }

   private:
    void read_statement() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        if (word == "f") return read_face(offset);
        if (word == "v") return count_up(above_.positions, positions_);
        if (word == "vn") return count_up(above_.normals, all_normals_);
        if (word == "usemtl") {
            ObjMaterials::Use use = rest();
            use.name = printable(use.name);
            chunk_.materials.push_back({chunk_.faces.size(), std::move(use)});
        } else if (word == "mtllib") {
            chunk_.libraries.push_back(rest());
        } else if (word == "l" || word == "p") {
            notes_.note(not_drawn, offset, "points and lines (p, l) are not drawn");
        } else if (std::ranges::count(ignored_words, word) == 0) {
            notes_.note(obj_ignored, offset, "unknown statement {}; {}", in_quotes(word),
                        suggestion(word, known_words, "known statements are"));
        }
    }

    /// Both passes count the same vertices; even if not, no index would be beyond the last.
    static void count_up(std::size_t& count, const Positions& all) {
        count = std::min(count + 1, all.size());
    }

    ObjMaterials::Use rest() {
        const std::size_t offset = scanner_.word_offset();
        return {std::string(scanner_.rest()), offset};
    }

    /// Converts an index from 1, or from -1 backward, to one from 0, and appends it; notes one that
    /// is wrong.
    bool resolve(std::int64_t index, std::size_t count, std::string_view what, std::size_t offset,
                 const Remedy& remedy, std::vector<std::uint32_t>& target) {
        const auto size = static_cast<std::int64_t>(count);
        if (index >= -size && index <= size && index != 0) {
            target.push_back(static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index));
            return true;
        }
        if (index == 0) {
            notes_.note(remedy, offset, "{} 0 does not exist; indices start at 1", what);
        } else {
            notes_.note(remedy, offset,
                        "{} {} does not exist, only {} defined above; correct the number", what,
                        index, count);
        }
        return false;
    }

    bool read_corner() {
        Corner& corner = parsed_.emplace_back();
        const std::size_t offset = scanner_.offset();
        if (const std::size_t length = parse_plain_corner(scanner_.left(), corner)) {
            scanner_.advance(length);
        } else if (const std::string_view word = scanner_.word(); !parse_corner(word, corner)) {
            notes_.note(bad_face, offset,
                        "{} is not a face corner; write v, v/vt, v//vn or v/vt/vn in whole numbers",
                        in_quotes(word));
            return false;
        }
        corner.offset = offset;
        return resolve(corner.position, above_.positions, "vertex", offset, bad_face, corners_);
    }

    void read_face(std::size_t offset) {
        parsed_.clear();
        corners_.clear();
        normals_.clear();
        while (scanner_.word_follows() && corners_.size() <= max_face_corners) {
            if (!read_corner()) return;
        }
        if (corners_.size() < 3) {
            notes_.note(bad_face, offset, "the face has {}; write three or more",
                        counted(corners_.size(), "corner"));
        } else if (corners_.size() > max_face_corners) {
            notes_.note(bad_face, offset, "the face has more than {} corners; split it",
                        max_face_corners);
        } else if (!all_readable_ && has_unreadable(corners_, positions_)) {
            notes_.note(bad_vertex, offset, "");
        } else {
            if (!read_normals(offset)) normals_.clear();
            auto* const rows = all_normals_.empty() ? nullptr : &chunk_.face_normals;
            const auto* blemish = append_face(corners_, normals_, positions_, notes_.text().size(),
                                              chunk_.faces, rows);
            if (blemish) notes_.note(blemish->remedy, offset, "{}", blemish->message);
        }
    }

    static bool has_unreadable(const std::vector<std::uint32_t>& indices, const Positions& all) {
        return std::ranges::any_of(indices, [&](std::uint32_t i) { return std::isnan(all[i].x); });
    }

    /// The face is flat without a note if none of its corners has a normal.
    bool read_normals(std::size_t offset) {
        if (std::ranges::none_of(parsed_, &Corner::has_normal)) return false;
        const auto lacking = std::ranges::find(parsed_, false, &Corner::has_normal);
        if (lacking != parsed_.end()) {
            notes_.note(bad_corner_normal, lacking->offset,
                        "only some corners of the face have normals; give normals to all or none");
            return false;
        }
        for (const Corner& corner : parsed_) {
            if (!resolve(corner.normal, above_.normals, "normal", corner.offset, bad_corner_normal,
                         normals_)) {
                return false;
            }
        }
        if (all_readable_ || !has_unreadable(normals_, all_normals_)) return true;
        notes_.note(bad_normal, offset, "");
        return false;
    }

    Chunk& chunk_;
    Mistakes& notes_;
    Counts above_;
    const Positions &positions_, &all_normals_;
    const bool all_readable_;  ///< the vertices of the file
    LineScanner scanner_;
    std::vector<Corner> parsed_;                    ///< of the face being read
    std::vector<std::uint32_t> corners_, normals_;  ///< their indices from 0
};

/// Reads the chunks of a file in parallel, first vertices, then faces, and joins them in file
/// order.
class ObjReader {
   public:
    ObjReader(std::string_view text, const std::string& file_name, const ReadPace& pace)
        : mistakes_(text, file_name), pace_(pace) {
        const std::vector<std::size_t> cuts = line_cuts(text, pace.chunk_bytes);
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            chunks_.push_back(
                {Mistakes(text, file_name), cuts[i - 1], cuts[i], {}, {}, {}, {}, {}, {}});
        }
    }

    Model read(const OpenLibrary& open) {
        read_chunks();
        std::size_t triangles = 0;
        for (const Chunk& chunk : chunks_) triangles += chunk.faces.size();
        mesh_.faces.reserve(triangles);
        if (!mesh_.normals.empty()) mesh_.face_normals.reserve(triangles);
        for (Chunk& chunk : chunks_) add(chunk);
        std::vector<int>& materials = mesh_.face_materials;
        materials.resize(triangles, material_);
        const bool same =
            std::ranges::adjacent_find(materials, std::not_equal_to{}) == materials.end();
        if (same) materials.resize(1, -1);
        const auto is_flat = [](const Face& row) { return row[0] == Scene::Mesh::no_normal; };
        if (std::ranges::all_of(mesh_.face_normals, is_flat)) mesh_.face_normals.clear();
        Model model;
        model.mesh = std::move(mesh_);
        if (model.mesh.faces.empty()) mistakes_.refuse_notes();
        if (open) {
            materials_.assign(model, open, mistakes_);
        } else {
            model.mesh.face_materials = {-1};
        }
        const std::vector<std::string> notes = mistakes_.notes();
        model.notes.insert(model.notes.begin(), notes.begin(), notes.end());
        return model;
    }

   private:
    template <typename Work>
    void for_each_chunk(Work work) {
        for_each_run(chunks_.size(), 1, pace_.threads,
                     [&](std::size_t i, std::size_t) { work(i); });
    }

    void read_chunks() {
        for_each_chunk([&](std::size_t i) { read_vertices(chunks_[i]); });
        std::vector<Counts> above{{}};
        bool all_readable = true;
        for (const Chunk& chunk : chunks_) {
            above.push_back({above.back().positions + chunk.positions.size(),
                             above.back().normals + chunk.normals.size()});
            all_readable = all_readable && chunk.notes.is_empty();
        }
        Positions& positions = mesh_.positions;
        Positions& normals = mesh_.normals;
        positions.resize(above.back().positions);
        normals.resize(above.back().normals);
        for_each_chunk([&](std::size_t i) {
            move_to(chunks_[i].positions, positions.data() + above[i].positions);
            move_to(chunks_[i].normals, normals.data() + above[i].normals);
        });
        for_each_chunk([&](std::size_t i) {
            FaceReader(chunks_[i], above[i], positions, normals, all_readable).read();
        });
        if (all_readable) return;
        for (Positions* all : {&positions, &normals}) {  // no face uses them
            std::ranges::replace_if(
                *all, [](const glm::dvec3& v) { return std::isnan(v.x); }, glm::dvec3(0, 0, 1));
        }
    }

    /// Moves the items and frees their memory.
    static void move_to(Positions& items, glm::dvec3* target) {
        std::ranges::copy(items, target);
        Positions().swap(items);
    }

    void add(Chunk& chunk) {
        for (const auto& [faces_before, material] : chunk.materials) {
            mesh_.face_materials.resize(mesh_.faces.size() + faces_before, material_);
            material_ = materials_.use(material);
        }
        const auto append = [](const std::vector<Face>& part, std::vector<Face>& all) {
            all.insert(all.end(), part.begin(), part.end());
        };
        append(chunk.faces, mesh_.faces);
        append(chunk.face_normals, mesh_.face_normals);
        for (const ObjMaterials::Use& library : chunk.libraries) materials_.use_library(library);
        mistakes_.take_notes(chunk.notes);
        chunk = {Mistakes({}, {}), 0, 0, {}, {}, {}, {}, {}, {}};
    }

    Mistakes mistakes_;
    ReadPace pace_;
    std::vector<Chunk> chunks_;
    Scene::Mesh mesh_;
    int material_ = -1;  ///< of subsequent faces
    ObjMaterials materials_;
};

}  // namespace

Model parse_obj(std::string_view text, const std::string& file_name, const OpenLibrary& open,
                const ReadPace& pace) {
    return ObjReader(text, file_name, pace).read(open);
}

}  // namespace rt
