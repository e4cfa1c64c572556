// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>

#include "host/base/text.h"
#include "host/scene/line_scanner.h"
#include "host/scene/scene_limits.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// A material as the file gives it.
struct Mtl {
    std::string name;
    glm::dvec3 ambient{0}, diffuse{0}, specular{0}, filter{1};
    double shininess = 1, ior = 1;
    std::optional<double> dissolve, transparency;
    int illum = 2;
    std::size_t ior_offset = 0;  ///< of the Ni statement
};

bool is_glass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }

double opacity_of(const Mtl& mtl) {
    return mtl.dissolve.value_or(1.0 - mtl.transparency.value_or(0.0));
}

bool is_clear(const Mtl& mtl) { return is_glass(mtl.illum) && opacity_of(mtl) < 1; }

/// Illumination models 3 to 8 trace reflections; 4, 6, 7 and 9 are glass; below 2 there are no
/// highlights.
Scene::Material to_material(const Mtl& mtl) {
    const double opacity = opacity_of(mtl);
    const bool clear = is_clear(mtl);
    Scene::Material material;
    material.name = mtl.name;
    material.ambient = clear ? opacity * mtl.ambient : mtl.ambient;
    material.diffuse = clear ? opacity * mtl.diffuse : mtl.diffuse;
    if (mtl.illum >= 2) material.specular = mtl.specular;
    if (mtl.illum >= 3 && mtl.illum <= 8) material.mirror = mtl.specular;
    if (clear) material.transmission = (1.0 - opacity) * mtl.filter;
    if (clear) material.ior = mtl.ior;
    material.shininess = mtl.shininess;
    material.two_sided = !clear;
    return material;
}

class MtlReader {
   public:
    MtlReader(std::string_view text, const std::string& file_name)
        : scanner_(text), mistakes_(text, file_name), file_name_(file_name) {}

    MtlLibrary read() {
        for (; scanner_.find_word(); scanner_.next_line()) read_statement();
        for (const Mtl& mtl : found_) check_ior(mtl);
        mistakes_.throw_if_any();
        MtlLibrary library;
        for (const Mtl& mtl : found_) library.materials.push_back(to_material(mtl));
        if (left_out_ > 0) {
            library.notes.push_back(fmt::format(
                "{}: ignored {}, the first {}: textures and extensions are not supported",
                file_name_, counted(left_out_, "statement"), in_quotes(first_left_out_)));
        }
        return library;
    }

   private:
    void read_statement() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        if (word == "newmtl") return start_material(offset);
        if (!known(word)) {
            if (left_out_++ == 0) first_left_out_ = word;
            return;
        }
        if (found_.empty()) {
            mistakes_.add(offset, fmt::format("{} comes before the first newmtl; write newmtl and "
                                              "a name above it",
                                              in_quotes(word)));
            return;
        }
        read_value(word, found_.back());
    }

    static bool known(std::string_view word) {
        constexpr std::string_view words[] = {"Ka", "Kd", "Ks", "Ns",   "Ni",
                                              "Tf", "d",  "Tr", "illum"};
        return std::ranges::find(words, word) != std::end(words);
    }

    void read_value(std::string_view word, Mtl& mtl) {
        if (word == "Ka") return read_color(word, mtl.ambient);
        if (word == "Kd") return read_color(word, mtl.diffuse);
        if (word == "Ks") return read_color(word, mtl.specular);
        if (word == "Tf") return read_color(word, mtl.filter);
        if (word == "Ns") return read_amount(word, 0, max_scene_number, mtl.shininess);
        if (word == "Ni") return read_ior(mtl);
        if (word == "illum") return read_illum(mtl);
        double amount = 1;
        if (word == "d") skip_halo();
        read_amount(word, 0, 1, amount);
        (word == "d" ? mtl.dissolve : mtl.transparency) = amount;
    }

    void start_material(std::size_t offset) {
        const std::string name = printable(scanner_.rest());
        if (name.empty()) mistakes_.add(offset, "newmtl gives no name; write one after it");
        const auto [first, is_new] = offsets_.emplace(name, offset);
        if (!is_new) {
            mistakes_.add(offset, fmt::format("material {} is defined twice, first at {}; keep "
                                              "one of them",
                                              in_quotes(name), mistakes_.place(first->second)));
        }
        found_.emplace_back().name = name;
    }

    /// Three numbers, or one for gray.
    void read_color(std::string_view word, glm::dvec3& color) {
        const bool there = scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        LineScanner ahead = scanner_;
        const std::string_view kind = ahead.word();
        if (there && (kind == "spectral" || kind == "xyz")) {
            mistakes_.add(offset, fmt::format("{} colors are not supported; write {} r g b",
                                              in_quotes(kind), word));
            return;
        }
        std::array<double, 3> rgb{};
        int count = 0;
        while (count < 3 && (count == 0 || scanner_.word_follows())) {
            if (!read_within(word, 0, max_reflectance, rgb[static_cast<std::size_t>(count)]))
                return;
            ++count;
        }
        if (count == 2) {
            mistakes_.add(offset,
                          fmt::format("{} has two numbers; write one for a gray, or three", word));
            return;
        }
        color = count == 1 ? glm::dvec3(rgb[0]) : glm::dvec3(rgb[0], rgb[1], rgb[2]);
        require_end(word);
    }

    void read_amount(std::string_view word, double low, double high, double& target) {
        if (read_within(word, low, high, target)) require_end(word);
    }

    bool read_within(std::string_view word, double low, double high, double& target) {
        scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        const auto number = read_number(scanner_, word, mistakes_);
        if (!number) return false;
        target = *number;
        if (*number >= low && *number <= high) return true;
        mistakes_.add(offset, fmt::format("{} is {}; write a number from {} to {}", word, *number,
                                          low, high));
        return false;
    }

    void read_ior(Mtl& mtl) {
        scanner_.word_follows();
        mtl.ior_offset = scanner_.offset();
        read_amount("Ni", 0, max_scene_number, mtl.ior);
    }

    /// Programs write "Ni 0" for opaque materials.
    void check_ior(const Mtl& mtl) {
        if (mtl.ior > 0 || !is_clear(mtl)) return;
        mistakes_.add(mtl.ior_offset, "Ni is 0; write an index of refraction above 0, like 1.5");
    }

    void read_illum(Mtl& mtl) {
        const bool there = scanner_.word_follows();
        const std::size_t offset = scanner_.offset();
        LineScanner ahead = scanner_;
        const auto number = there ? scanner_.integer() : std::nullopt;
        if (number && *number >= 0 && *number <= 10) {
            mtl.illum = static_cast<int>(*number);
            return require_end("illum");
        }
        const std::string found = there ? in_quotes(ahead.word()) : "missing";
        mistakes_.add(offset, fmt::format("illum is {}; write a whole number from 0 to 10", found));
    }

    void skip_halo() {
        LineScanner ahead = scanner_;
        if (ahead.word() == "-halo") scanner_ = ahead;
    }

    void require_end(std::string_view word) {
        if (!scanner_.word_follows()) return;
        const std::size_t offset = scanner_.offset();
        mistakes_.add(offset, fmt::format("unexpected {} after the numbers of {}; remove it",
                                          in_quotes(scanner_.word()), word));
    }

    LineScanner scanner_;
    Mistakes mistakes_;
    std::string file_name_;
    std::vector<Mtl> found_;
    std::unordered_map<std::string, std::size_t> offsets_;
    std::size_t left_out_ = 0;
    std::string_view first_left_out_;
};

}  // namespace

MtlLibrary parse_mtl(std::string_view text, const std::string& file_name) {
    return MtlReader(text, file_name).read();
}

}  // namespace rt
