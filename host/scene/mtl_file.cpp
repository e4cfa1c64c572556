// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <unordered_set>
#include <utility>

#include "host/base/text.h"
#include "host/scene/line_scanner.h"
#include "host/scene/scene.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr Remedy mtl_ignored{"statement ignored", "statements ignored"};
constexpr Remedy unsupported = mtl_ignored;
constexpr Remedy value_ignored{"value ignored", "values ignored"};
constexpr Remedy value_limited{"value limited", "values limited"};
constexpr Remedy unknown{"material is gray", "materials are gray"};
constexpr Remedy missing{"library missing", "libraries missing"};

/// A material as the file gives it.
struct Mtl {
    std::string name;
    std::optional<glm::dvec3> ambient, diffuse;
    glm::dvec3 specular{0}, filter{1};
    double shininess = 1, ior = 1;
    std::optional<double> dissolve, transparency;
    int illum = 2;
};

/// Illumination models 3 to 8 trace reflections; 4, 6, 7 and 9 are glass; below 2 there are no
/// highlights. Nor are there with exponents near 0, which exporters write for "none". They also
/// write a Ka of 1 whatever the color is, so Kd takes its place.
Scene::Material to_material(const Mtl& mtl) {
    constexpr double least_shininess = 0.5;
    const int illum = mtl.illum;
    const double opacity = mtl.dissolve.value_or(1.0 - mtl.transparency.value_or(0.0));
    const bool clear = (illum == 4 || illum == 6 || illum == 7 || illum == 9) && opacity < 1;
    Scene::Material material;
    material.name = mtl.name;
    material.ambient = mtl.ambient.value_or(glm::dvec3(0));
    material.diffuse = mtl.diffuse.value_or(glm::dvec3(0));
    if (material.ambient == glm::dvec3(1) && mtl.diffuse) material.ambient = material.diffuse;
    if (illum >= 2 && mtl.shininess >= least_shininess) material.specular = mtl.specular;
    if (illum >= 3 && illum <= 8) material.mirror = mtl.specular;
    material.shininess = mtl.shininess;
    material.two_sided = !clear;
    if (!clear) return material;
    material.ambient *= opacity;
    material.diffuse *= opacity;
    material.transmission = (1.0 - opacity) * mtl.filter;
    material.ior = mtl.ior > 0 ? mtl.ior : 1;
    return material;
}

class MtlReader {
   public:
    MtlReader(std::string_view text, const std::string& file_name)
        : scanner_(text), mistakes_(text, file_name) {}

    MtlLibrary read() {
        for (; scanner_.find_word(); scanner_.next_line()) read_statement();
        finish_material();
        return {std::move(materials_), mistakes_.notes()};
    }

   private:
    void read_statement() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        if (word == "newmtl") return start_material(offset);
        if (!mtl_) {
            mistakes_.note(mtl_ignored, offset,
                           "{} comes before the first newmtl; write newmtl and a name "
                           "above it",
                           in_quotes(word));
        } else if (!read_value(word, *mtl_)) {
            mistakes_.note(unsupported, offset,
                           "unknown statement {}: textures and extensions are not "
                           "supported",
                           in_quotes(word));
        }
    }

    bool read_value(std::string_view word, Mtl& mtl) {
        if (word == "Ka" || word == "Kd") {
            read_color(word, word == "Ka" ? mtl.ambient : mtl.diffuse);
        } else if (word == "Ks" || word == "Tf") {
            std::optional<glm::dvec3> color;
            read_color(word, color);
            if (color) (word == "Ks" ? mtl.specular : mtl.filter) = *color;
        } else if (word == "Ns" || word == "Ni") {
            read_amount(word, max_scene_number, word == "Ns" ? mtl.shininess : mtl.ior);
        } else if (word == "illum") {
            read_illum(mtl);
        } else if (word == "d" || word == "Tr") {
            if (LineScanner ahead = scanner_; ahead.word() == "-halo") scanner_ = ahead;
            double amount = -1;
            read_amount(word, 1, amount);
            if (amount >= 0) (word == "d" ? mtl.dissolve : mtl.transparency) = amount;
        } else {
            return false;
        }
        return true;
    }

    void start_material(std::size_t offset) {
        finish_material();
        mtl_ = Mtl();
        mtl_->name = printable(scanner_.rest());
        if (mtl_->name.empty()) {
            mistakes_.note(mtl_ignored, offset, "newmtl gives no name; write one after it");
            return;
        }
        if (names_.insert(mtl_->name).second) return;
        mistakes_.note(mtl_ignored, offset, "material {} is defined above; the first counts",
                       in_quotes(mtl_->name));
        mtl_->name.clear();
    }

    /// Keeps the material above, unless it has no name of its own.
    void finish_material() {
        if (mtl_ && !mtl_->name.empty()) materials_.push_back(to_material(*mtl_));
    }

    /// Three numbers, or one for gray.
    void read_color(std::string_view word, std::optional<glm::dvec3>& color) {
        glm::dvec3 rgb{0};
        int count = 0;
        for (; count < 3 && (count == 0 || scanner_.word_follows()); ++count) {
            double channel = -1;
            read_amount(word, max_reflectance, channel);
            if (channel < 0) return;
            rgb[count] = channel;
        }
        if (count == 2) {
            mistakes_.note(value_ignored, scanner_.offset(),
                           "{} has two numbers; write one for a gray, or three", word);
        } else {
            color = count == 1 ? glm::dvec3(rgb[0]) : rgb;
        }
    }

    /// Reads a number from 0 to `most` into `target`; one beyond is limited.
    void read_amount(std::string_view word, double most, double& target) {
        const std::size_t offset = scanner_.word_offset();
        const auto number = scan_number(scanner_, word, mistakes_, &value_ignored);
        if (!number) return;
        target = std::clamp(*number, 0.0, most);
        if (target == *number) return;
        mistakes_.note(value_limited, offset, "{} is {}; write a number from 0 to {}", word,
                       *number, most);
    }

    void read_illum(Mtl& mtl) {
        constexpr int last = 10;
        const std::size_t offset = scanner_.word_offset();
        const auto number = scanner_.integer();
        if (number && *number >= 0 && *number <= last) {
            mtl.illum = static_cast<int>(*number);
            return;
        }
        mistakes_.note(value_ignored, offset, "illum is {}; write a whole number from 0 to {}",
                       found_text(scanner_, number), last);
    }

    LineScanner scanner_;
    Mistakes mistakes_;
    std::optional<Mtl> mtl_;  ///< the one being read
    std::vector<Scene::Material> materials_;
    std::unordered_set<std::string> names_;
};

/// Reads libraries into a model: each file once, and the first material of each name.
class Libraries {
   public:
    Libraries(Model& model, const OpenLibrary& open, const std::string& obj_name)
        : model_(model), open_(open), obj_name_(obj_name) {}

    /// Adds what an mtllib statement names: one file, if there is one of that name (names may hold
    /// blanks), else one per word. If there is none, the library may be called as the model is.
    /// Returns the problem, if any.
    std::string add_all(const std::string& names) {
        const std::string problem = add(names);
        if (problem.empty()) return {};
        std::string missing_one;
        bool has_some = false;
        for (LineScanner scanner(names); scanner.word_follows();) {
            const std::string word(scanner.word());
            const std::string missing_word = add_path(word);
            has_some = has_some || missing_word.empty();
            // Other words may be parts of a path with blanks.
            if (missing_one.empty() && lower(word).ends_with(".mtl")) missing_one = missing_word;
        }
        if (has_some) return missing_one;
        const std::string of_model = std::filesystem::path(obj_name_).stem().string() + ".mtl";
        return add_path(names).empty() || add(of_model).empty() ? "" : problem;
    }

   private:
    /// Adds a file whose name may be a path that an exporter on another system has written.
    std::string add_path(std::string name) {
        const std::string problem = add(name);
        if (problem.empty()) return {};
        std::ranges::replace(name, '\\', '/');
        const bool is_there = add(name).empty() || add(name.substr(name.rfind('/') + 1)).empty();
        return is_there ? "" : problem;
    }

    std::string add(const std::string& name) {
        const auto [known, is_new] = problems_.try_emplace(name);
        if (!is_new) return known->second;
        const LibraryFile file = open_(name);
        known->second = file.problem;
        if (!file.problem.empty()) return file.problem;
        model_.library_files.push_back(file.path);
        MtlLibrary library = parse_mtl(file.text, printable(file.path));
        for (Scene::Material& material : library.materials) {
            if (known_.insert(material.name).second)
                model_.materials.push_back(std::move(material));
        }
        std::ranges::move(library.notes, std::back_inserter(model_.notes));
        return {};
    }

    Model& model_;
    const OpenLibrary& open_;
    const std::string& obj_name_;
    std::unordered_map<std::string, std::string> problems_;  ///< of each name that was tried
    std::unordered_set<std::string> known_;
};

}  // namespace

MtlLibrary parse_mtl(std::string_view text, const std::string& file_name) {
    return MtlReader(text, file_name).read();
}

int ObjMaterials::use(const Use& material) {
    if (material.name.empty()) return -1;
    const auto [found, is_new] = numbers_.emplace(material.name, static_cast<int>(used_.size()));
    if (is_new) used_.push_back(material);
    return found->second;
}

void ObjMaterials::assign(Model& model, const OpenLibrary& open, Mistakes& mistakes) {
    constexpr int most_missing = 100;  // so that a file full of them takes no time
    Libraries libraries(model, open, mistakes.file_name());
    int lacking = 0;
    for (const Use& statement : libraries_) {
        const bool tries = lacking < most_missing;
        const std::string problem = tries ? libraries.add_all(statement.name) : "not looked for";
        if (problem.empty()) continue;
        ++lacking;
        mistakes.note(missing, statement.offset, "{}; until then its materials are gray", problem);
    }
    std::unordered_map<std::string_view, int> known;
    std::vector<std::string_view> names;
    for (const Scene::Material& material : model.materials) {
        known.emplace(material.name, static_cast<int>(known.size()));
        names.push_back(material.name);
    }
    const auto fallback = static_cast<int>(model.materials.size());
    std::vector<int> indices;
    std::vector<const Use*> unknown_ones;
    for (const Use& use : used_) {
        const auto found = known.find(use.name);
        indices.push_back(found == known.end() ? fallback : found->second);
        if (found == known.end() && lacking == 0) unknown_ones.push_back(&use);
    }
    if (!unknown_ones.empty()) {
        const Use& first = *unknown_ones[0];
        std::string advice = "the libraries contain none";
        if (libraries_.empty()) advice = "the file has no mtllib";
        if (!names.empty()) advice = suggestion(first.name, names, "the libraries contain");
        mistakes.report(&unknown, first.offset,
                        fmt::format("unknown material {}; {}", in_quotes(first.name), advice),
                        unknown_ones.size());
    }
    std::vector<int>& faces = model.mesh.face_materials;
    if (libraries_.empty()) {
        faces = {-1};
        return;
    }
    for (int& face : faces) face = face < 0 ? fallback : indices[static_cast<std::size_t>(face)];
    if (std::ranges::find(faces, fallback) != faces.end()) {
        model.materials.push_back(default_material());
    }
}

Scene::Material default_material() {
    Scene::Material material;
    material.name = "default";
    material.ambient = material.diffuse = glm::dvec3(0.7);
    material.two_sided = true;
    return material;
}

}  // namespace rt
