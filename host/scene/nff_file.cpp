// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/geometry_checks.h"
#include "host/scene/nff_fill.h"
#include "host/scene/nff_polygon.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/nff_view.h"
#include "host/scene/scene_name.h"
#include "host/scene/text_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::size_t max_nff_bytes = std::size_t{1} << 30;
constexpr std::size_t max_nff_primitives = std::size_t{1} << 24;

// The databases' reference settings (their Readme, "Testing Procedures", 7: a tree of depth 5).
constexpr int nff_bounces = 4;
constexpr int nff_side = 512;

constexpr std::string_view entities[] = {"v", "b", "l", "f", "c", "s", "p", "pp"};

bool is_entity(std::string_view word) {
    return std::ranges::find(entities, word) != std::end(entities);
}

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
        scene_.materials = fills_.take();
        set_light();
        return std::move(scene_);
    }

   private:
    bool read_entity() {
        const NffToken word = tokens_.take();
        if (word.text == "f") return fills_.read(tokens_);
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
        std::string advice = "NFF has v, b, l, f, c, s, p and pp; extensions are not supported";
        if (word.is_number()) advice = "one number too many, or an entity's letter is missing";
        if (word.text == "nff" && !view_) advice = "this is Sense8's NFF, a different format";
        mistakes_.add(word.offset,
                      fmt::format("unknown entity {}; {}", in_quotes(word.text), advice));
    }

    /// Error recovery: skips to a line that begins with an entity, or at least with a word. Lines
    /// of a view or an extension may begin with words of their own.
    void skip_to_entity(bool skips_words) {
        const auto goes_on = [&](const NffToken& token) {
            if (!token.first_on_line || token.is_number()) return false;
            return !skips_words || is_entity(token.text);
        };
        while (!tokens_.peek().text.empty() && !goes_on(tokens_.peek())) tokens_.take();
    }

    /// Notes the repetition of an entity that may appear only once.
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
        const auto color = tokens_.read_color("background");
        if (color) scene_.background = *color;
        return color.has_value();
    }

    bool read_light() {
        tokens_.expect("l x y z, with red green blue or without");
        const auto position = tokens_.read_vec3("light position");
        if (!position) return false;
        Scene::Light light;
        light.position = *position;
        light.has_own_intensity = tokens_.peek().is_number();
        if (light.has_own_intensity) {
            const auto color = tokens_.read_color("light color");
            if (!color) return false;
            light.intensity = *color;
        }
        scene_.lights.push_back(light);
        return true;
    }

    bool read_polygon(const NffToken& word, bool is_patch) {
        return polygons_.read(tokens_, word.offset, is_patch, fills_, scene_.triangles);
    }

    bool read_sphere() {
        tokens_.expect("s x y z radius");
        const auto center = tokens_.read_vec3("center");
        if (!center) return false;
        const std::size_t offset = tokens_.peek().offset;
        const auto radius = tokens_.read_number("radius");
        if (!radius) return false;
        if (*radius == 0) mistakes_.add(offset, "radius is 0; write a larger one");
        scene_.spheres.push_back({*center, std::abs(*radius), fills_.current()});
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
            mistakes_.add(apex_offset, same_cone_ends);
        }
        if (std::min(*base_radius, *apex_radius) < 0 && std::max(*base_radius, *apex_radius) > 0) {
            mistakes_.add(offset, "the radii have opposite signs; give both the same sign");
        } else if (*base_radius == 0 && *apex_radius == 0) {
            mistakes_.add(offset, zero_cone_radii);
        }
        scene_.cones.push_back(
            {*base, *apex, std::abs(*base_radius), std::abs(*apex_radius), fills_.current()});
        return true;
    }

    void check_size() const {
        const std::size_t count =
            scene_.spheres.size() + scene_.cones.size() + scene_.triangles.size();
        if (count <= max_nff_primitives) return;
        throw Error(ExitCode::limit, fmt::format("{}: more than {} primitives; split the scene",
                                                 printable(file_name_), max_nff_primitives));
    }

    /// The databases' Readme proposes sqrt(n) / 2n, for n lights, as the intensity of each light
    /// and of the ambient light.
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
    std::optional<std::size_t> view_, background_;  ///< their offsets
    NffFills fills_{mistakes_};
    NffPolygons polygons_{mistakes_};
};

}  // namespace

Scene load_nff_scene(const std::string& path) {
    return parse_nff_scene(read_text_file(path, max_nff_bytes).view(), path);
}

Scene parse_nff_scene(std::string_view text, const std::string& file_name) {
    Mistakes mistakes(text, file_name);
    Scene scene = NffReader(mistakes, file_name).read();
    scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
