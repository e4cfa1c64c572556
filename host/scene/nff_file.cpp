// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "host/error.h"
#include "host/scene/geometry_checks.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/nff_view.h"
#include "host/scene/polygon.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::size_t max_nff_bytes = std::size_t{1} << 30;
constexpr std::size_t max_nff_primitives = std::size_t{1} << 24;

// What the databases are rendered with (their Readme, "Testing Procedures", 7: a tree of depth 5).
constexpr int nff_bounces = 4;
constexpr int nff_side = 512;

constexpr std::string_view entities[] = {"v", "b", "l", "f", "c", "s", "p", "pp"};

bool is_entity(std::string_view word) {
    return std::ranges::find(entities, word) != std::end(entities);
}

/// The numbers after an f.
using Fill = std::array<double, 8>;

class NffReader {
   public:
    NffReader(Mistakes& mistakes, const std::string& file_name)
        : mistakes_(mistakes), file_name_(file_name), tokens_(mistakes) {
        scene_.width = scene_.height = nff_side;
        scene_.max_bounces = nff_bounces;
    }

    Scene read() {
        while (!tokens_.peek().text.empty()) {
            const std::string_view word = tokens_.peek().text;
            const bool skips_words = word == "v" || !is_entity(word);
            if (!read_entity()) skip_to_entity(skips_words);
            check_size();
        }
        if (!view_) mistakes_.add(0, "the file has no view; add v with from, at, up and angle");
        mistakes_.throw_if_any();
        set_light();
        return std::move(scene_);
    }

   private:
    bool read_entity() {
        const NffToken word = tokens_.take();
        if (word.text == "f") return read_fill();
        if (word.text == "s") return read_sphere();
        if (word.text == "c") return read_cone();
        if (word.text == "p") return read_polygon(word, false);
        if (word.text == "pp") return read_polygon(word, true);
        if (word.text == "l") return read_light();
        if (word.text == "b") return read_background(word);
        if (word.text == "v") return read_view(word);
        note_unknown(word);
        return false;
    }

    void note_unknown(const NffToken& word) {
        std::string advice = "there are v, b, l, f, c, s, p and pp, and no extensions";
        if (word.is_number()) advice = "one number too many, or an entity's letter is missing";
        if (word.text == "nff" && !view_) advice = "this is Sense8's NFF, another format";
        mistakes_.add(word.offset,
                      fmt::format("unknown entity {}; {}", in_quotes(word.text), advice));
    }

    /// After a mistake: on to a line that begins with an entity, or at least with a word. What
    /// belongs to a view or to an extension may begin with words of its own.
    void skip_to_entity(bool skips_words) {
        const auto goes_on = [&](const NffToken& token) {
            if (!token.first_on_line || token.is_number()) return false;
            return !skips_words || is_entity(token.text);
        };
        while (!tokens_.peek().text.empty() && !goes_on(tokens_.peek())) tokens_.take();
    }

    /// Notes an entity that may be there only once.
    void note_repeated(const NffToken& word, std::optional<std::size_t>& first) {
        if (first) {
            mistakes_.add(word.offset, fmt::format("a second '{}', first at {}; keep one of them",
                                                   word.text, mistakes_.place(*first)));
        }
        first = word.offset;
    }

    bool read_view(const NffToken& word) {
        note_repeated(word, view_);
        return read_nff_view(tokens_, word.offset, scene_, mistakes_);
    }

    bool read_background(const NffToken& word) {
        note_repeated(word, background_);
        tokens_.expect("b red green blue");
        const auto colour = tokens_.read_colour("background");
        if (colour) scene_.background = *colour;
        return colour.has_value();
    }

    bool read_light() {
        tokens_.expect("l x y z, with red green blue or without");
        const auto position = tokens_.read_vec3("light position");
        if (!position) return false;
        Scene::Light light;
        light.position = *position;
        light.has_own_intensity = tokens_.peek().is_number();
        if (light.has_own_intensity) {
            const auto colour = tokens_.read_colour("light colour");
            if (!colour) return false;
            light.intensity = *colour;
        }
        scene_.lights.push_back(light);
        return true;
    }

    bool read_fill() {
        constexpr const char* names[] = {"red", "green", "blue", "Kd", "Ks", "Shine", "T", "ior"};
        tokens_.expect("f red green blue Kd Ks Shine T ior");
        Fill fill{};
        std::size_t last = 0;
        for (std::size_t i = 0; i < fill.size(); ++i) {
            last = tokens_.peek().offset;
            const auto number = tokens_.read_not_negative(names[i]);
            if (!number) return false;
            fill[i] = *number;
        }
        if (fill[6] > 0 && fill[7] == 0) {
            mistakes_.add(last,
                          "ior is 0 where T is not; write an index above 0, 1 to go straight");
            return true;
        }
        use(fill);
        return true;
    }

    /// Makes a material of the fill, unless there is one already, and uses it from here on.
    void use(const Fill& fill) {
        const auto next = static_cast<int>(scene_.materials.size());
        const auto [known, is_new] = fills_.try_emplace(fill, next);
        material_ = known->second;
        if (!is_new) return;
        const auto [red, green, blue, kd, ks, shine, t, ior] = fill;
        Scene::Material material;
        material.name = fmt::format("f{}", next + 1);
        material.diffuse = glm::dvec3(red, green, blue) * kd;
        material.ambient = material.diffuse;
        material.specular = material.mirror = glm::dvec3(ks, ks, ks);
        material.shininess = shine;
        material.transmission = glm::dvec3(t, t, t);
        material.ior = t > 0 ? ior : 1;
        material.two_sided = true;
        scene_.materials.push_back(material);
    }

    /// What is used now; white and matt before the first f.
    int material() {
        if (material_ < 0) use({1, 1, 1, 1, 0, 0, 0, 1});
        return material_;
    }

    bool read_sphere() {
        tokens_.expect("s x y z radius");
        const auto center = tokens_.read_vec3("centre");
        if (!center) return false;
        const std::size_t offset = tokens_.peek().offset;
        const auto radius = tokens_.read_number("radius");
        if (!radius) return false;
        if (*radius == 0) mistakes_.add(offset, "radius is 0; write a larger one");
        scene_.spheres.push_back({*center, std::abs(*radius), material()});
        return true;
    }

    bool read_cone() {
        tokens_.expect("c base x y z radius apex x y z radius (numbers only)");
        const auto base = tokens_.read_vec3("base");
        const std::size_t offset = tokens_.peek().offset;
        const auto base_radius = base ? tokens_.read_number("base radius") : std::nullopt;
        const std::size_t apex_offset = tokens_.peek().offset;
        const auto apex = base_radius ? tokens_.read_vec3("apex") : std::nullopt;
        const auto apex_radius = apex ? tokens_.read_number("apex radius") : std::nullopt;
        if (!apex_radius) return false;
        if (nearly_same_point(*base, *apex)) {
            mistakes_.add(apex_offset, "apex is the same point as base; move one of them");
        }
        if (*base_radius * *apex_radius < 0) {
            mistakes_.add(offset, "one radius is negative and one is not; make both alike");
        } else if (*base_radius == 0 && *apex_radius == 0) {
            mistakes_.add(offset, "both radii are 0; make one of them larger");
        }
        scene_.cones.push_back(
            {*base, *apex, std::abs(*base_radius), std::abs(*apex_radius), material()});
        return true;
    }

    bool read_polygon(const NffToken& word, bool is_patch) {
        tokens_.expect(is_patch ? "pp count, and so often x y z nx ny nz"
                                : "p count, and so often x y z");
        const auto count = read_corner_count(is_patch ? 12 : 6);
        if (!count) return false;
        corners_.clear();
        normals_.clear();
        for (int i = 0; i < *count; ++i) {
            const auto corner = tokens_.read_vec3("vertex");
            if (!corner) return false;
            corners_.push_back(*corner);
            if (is_patch && !read_normal()) return false;
        }
        add_polygon(word);
        return true;
    }

    /// A count is refused before anything is made of it when the rest of the file cannot hold so
    /// many vertices of at least so many bytes.
    std::optional<int> read_corner_count(std::size_t vertex_bytes) {
        const std::size_t offset = tokens_.peek().offset;
        const auto count = tokens_.read_integer("vertex count", 3, 1 << 30);
        if (!count) return std::nullopt;
        const std::size_t most = (tokens_.bytes_left() + 1) / vertex_bytes;
        if (static_cast<std::size_t>(*count) <= most) return count;
        mistakes_.add(offset,
                      fmt::format("vertex count is {}, and the rest of the file is too short "
                                  "for so many; write how many follow",
                                  *count));
        return std::nullopt;
    }

    bool read_normal() {
        const std::size_t offset = tokens_.peek().offset;
        const auto normal = tokens_.read_vec3("normal");
        if (!normal) return false;
        const auto unit = unit_direction(*normal);
        if (!unit) mistakes_.add(offset, "a vertex normal is zero; give it a direction");
        normals_.push_back(unit.value_or(glm::dvec3(0, 0, 1)));
        return true;
    }

    void add_polygon(const NffToken& word) {
        const PolygonFault fault = triangulate(corners_, polygon_work_, faces_);
        if (fault == PolygonFault::zero_area) return;
        if (fault != PolygonFault::none) return note_polygon(word, fault);
        for (const auto& [a, b, c] : faces_) {
            Scene::Triangle triangle;
            triangle.vertices = {corners_[a], corners_[b], corners_[c]};
            if (zero_area(triangle.vertices)) continue;
            if (!normals_.empty()) triangle.normals = {normals_[a], normals_[b], normals_[c]};
            triangle.material = material();
            scene_.triangles.push_back(triangle);
        }
    }

    void note_polygon(const NffToken& word, PolygonFault fault) {
        if (fault == PolygonFault::too_intricate) {
            throw Error(ExitCode::limit,
                        mistakes_.place(word.offset) +
                            ": the file's polygons are too intricate; split those with thousands "
                            "of vertices");
        }
        mistakes_.add(word.offset, fault == PolygonFault::bent
                                       ? "the polygon is not flat; split it into triangles"
                                       : "the polygon crosses itself; split it where it does");
    }

    void check_size() const {
        const std::size_t count =
            scene_.spheres.size() + scene_.cones.size() + scene_.triangles.size();
        if (count <= max_nff_primitives) return;
        throw Error(ExitCode::limit, fmt::format("{}: more than {} primitives; split the scene",
                                                 file_name_, max_nff_primitives));
    }

    /// The databases' Readme proposes sqrt(n) / 2n, of n lights, for each light and for the
    /// ambient light.
    void set_light() {
        const auto n = static_cast<double>(scene_.lights.size());
        const double share = n > 0 ? std::sqrt(n) / (2 * n) : 1;
        scene_.ambient_light = glm::dvec3(share, share, share);
        for (Scene::Light& light : scene_.lights) {
            if (!light.has_own_intensity) light.intensity = glm::dvec3(share, share, share);
        }
    }

    Mistakes& mistakes_;
    const std::string& file_name_;
    NffTokens tokens_;
    Scene scene_;
    std::optional<std::size_t> view_, background_;  ///< where they stand
    std::map<Fill, int> fills_;
    int material_ = -1;  ///< of the primitives to come; -1: the file has named none
    std::vector<glm::dvec3> corners_, normals_;  ///< of the polygon at hand
    std::vector<std::array<std::uint32_t, 3>> faces_;
    std::int64_t polygon_work_ = max_polygon_work;
};

}  // namespace

Scene load_nff_scene(const std::string& path) {
    return parse_nff_scene(read_text_file(path, max_nff_bytes), path);
}

Scene parse_nff_scene(std::string_view text, const std::string& file_name) {
    Mistakes mistakes(text, file_name);
    Scene scene = NffReader(mistakes, file_name).read();
    scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
