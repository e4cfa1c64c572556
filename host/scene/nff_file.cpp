// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/geometry.h"
#include "host/scene/line_scanner.h"
#include "host/scene/polygon.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::size_t max_nff_primitives = std::size_t{1} << 24;

// The databases' reference settings (their Readme, "Testing Procedures", 7: a tree of depth 5).
constexpr int nff_bounces = 4;
constexpr int nff_side = 512;

constexpr Remedy left_out{"shape left out", "shapes left out"};
constexpr Remedy statement_ignored{"statement ignored", "statements ignored"};
constexpr Remedy number_ignored{"number ignored", "numbers ignored"};
constexpr Remedy value_replaced{"value replaced", "values replaced"};
constexpr Remedy made_flat{"polygon made flat", "polygons made flat"};

struct Usage {
    std::string_view word, usage;
};

constexpr Usage entities[] = {{"v", "v, then from, at, up and angle"},
                              {"b", "b red green blue"},
                              {"l", "l x y z, with red green blue or without"},
                              {"f", "f red green blue Kd Ks Shine T ior"},
                              {"c", "c base x y z radius apex x y z radius (numbers only)"},
                              {"s", "s x y z radius"},
                              {"p", "p count, then count times x y z"},
                              {"pp", "pp count, then count times x y z nx ny nz"}};
constexpr Usage view_parts[] = {{"from", "from x y z"},
                                {"at", "at x y z"},
                                {"up", "up x y z"},
                                {"angle", "angle degrees"},
                                {"hither", "hither distance"},
                                {"resolution", "resolution width height"}};

/// Lines have no meaning: numbers and words are separated by blanks and line ends. A shape that
/// cannot be read is left out with a note; only the view must be right.
class NffReader {
   public:
    NffReader(std::string_view text, const std::string& file_name)
        : scanner_(text), mistakes_(text, file_name) {
        scene_.width = scene_.height = nff_side;
        scene_.max_bounces = nff_bounces;
    }

    Scene read() {
        while (scanner_.find_word()) {
            read_entity() ? skip_numbers() : skip_to_entity();
            if (shape_count() > max_nff_primitives) {
                throw Error(ExitCode::limit,
                            fmt::format("{}: more than {} primitives; split the scene",
                                        mistakes_.file_name(), max_nff_primitives));
            }
        }
        if (!view_) mistakes_.add(0, "the file has no view; add v with from, at, up and angle");
        mistakes_.throw_if_any();
        if (shape_count() == 0 && has_lost_) mistakes_.refuse_notes();
        set_light();
        scene_.notes = mistakes_.notes();
        return std::move(scene_);
    }

   private:
    std::size_t shape_count() const {
        return scene_.spheres.size() + scene_.cones.size() + scene_.triangles.size();
    }

    bool read_entity() {
        const std::size_t offset = scanner_.offset();
        const std::string_view word = scanner_.word();
        const auto known = std::ranges::find(entities, word, &Usage::word);
        skips_words_ = word == "v" || known == std::end(entities);
        if (known == std::end(entities)) return note_unknown(word, offset);
        usage_ = known->usage;
        remedy_ = word == "v"                  ? nullptr
                  : word == "b" || word == "l" ? &statement_ignored
                                               : &left_out;
        if (word == "v") return read_view(offset);
        if (word == "b") return read_background(offset);
        if (word == "l") return read_light();
        if (word == "f") return read_fill();
        if (word == "c") return read_cone(offset);
        if (word == "s") return read_sphere();
        return read_polygon(word == "pp");
    }

    bool note_unknown(std::string_view word, std::size_t offset) {
        has_lost_ = true;
        if (word == "nff" && !view_) {
            mistakes_.add(offset, "unknown entity 'nff'; this is Sense8's NFF, a different format");
        } else {
            mistakes_.note(statement_ignored, offset,
                           "unknown entity {}; NFF has v, b, l, f, c, s, p and pp; "
                           "extensions are not supported",
                           in_quotes(word));
        }
        return false;
    }

    /// Notes what is wrong with the entity at hand, or in a view adds it to the errors.
    void report(std::size_t offset, std::string message) {
        has_lost_ = has_lost_ || remedy_ == &left_out;
        mistakes_.report(remedy_, offset, std::move(message));
    }

    std::size_t next_offset() {
        scanner_.find_word();
        return scanner_.offset();
    }

    /// Whether the next word is a number, or looks meant as one.
    bool number_follows() {
        if (!scanner_.find_word()) return false;
        const std::string_view left = scanner_.left();
        const char c = left[0];
        if ((c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+') return true;
        if (std::string_view("nNiI").find(c) == left.npos) return false;
        const std::string word = lower(std::string(LineScanner(scanner_).word()));
        return word == "nan" || word == "inf";
    }

    std::optional<double> read_next(std::string_view name) {
        if (number_follows()) {
            const auto number = scan_number(scanner_, name, mistakes_, remedy_);
            has_lost_ = has_lost_ || (!number && remedy_ == &left_out);
            return number;
        }
        const std::string_view word = LineScanner(scanner_).word();
        report(scanner_.offset(),
               word.empty()
                   ? fmt::format("the file ends before {}; write {}", name, usage_)
                   : fmt::format("expected {}, found {}; write {}", name, in_quotes(word), usage_));
        return std::nullopt;
    }

    std::optional<glm::dvec3> read_vec3(std::string_view name) {
        const auto x = read_next(name);
        const auto y = x ? read_next(name) : std::nullopt;
        const auto z = y ? read_next(name) : std::nullopt;
        return z ? std::optional(glm::dvec3(*x, *y, *z)) : std::nullopt;
    }

    /// A negative channel is 0.
    std::optional<glm::dvec3> read_color(std::string_view name) {
        const std::size_t offset = next_offset();
        auto color = read_vec3(name);
        for (int i = 0; color && i < 3; ++i) {
            (*color)[i] = at_least_0((*color)[i], name, offset);
        }
        return color;
    }

    double at_least_0(double number, std::string_view name, std::size_t offset) {
        if (number >= 0) return number;
        mistakes_.note(value_replaced, offset, "{} is {}; write 0 or more", name, number);
        return 0;
    }

    double at_most(double number, std::string_view name, std::size_t offset) {
        if (number <= max_reflectance) return number;
        mistakes_.note(value_replaced, offset, "{} is {}; write {} at most", name, number,
                       max_reflectance);
        return max_reflectance;
    }

    std::optional<int> read_integer(std::string_view name, int low, int high) {
        const std::size_t offset = next_offset();
        const auto number = read_next(name);
        if (!number) return std::nullopt;
        if (*number >= low && *number <= high && *number == std::floor(*number)) {
            return static_cast<int>(*number);
        }
        report(offset, fmt::format("{} is {}; write a whole number from {} to {}", name, *number,
                                   low, high));
        return std::nullopt;
    }

    void skip_numbers() {
        while (number_follows()) {
            const std::size_t offset = scanner_.offset();
            mistakes_.note(number_ignored, offset,
                           "{} is one number too many, or an entity's letter is "
                           "missing",
                           in_quotes(scanner_.word()));
        }
    }

    bool at_line_start() const {
        const std::string_view before = mistakes_.text().substr(0, scanner_.offset());
        const std::size_t last = before.find_last_not_of(" \t\v\f");
        return last == before.npos || before[last] == '\n' || before[last] == '\r';
    }

    /// Error recovery: skips to a line that begins with an entity, or at least with a word. Lines
    /// of a view or an extension may begin with words of their own.
    void skip_to_entity() {
        if (scanner_.find_word() && !at_line_start()) scanner_.next_line();
        for (; scanner_.find_word(); scanner_.next_line()) {
            const std::string_view word = LineScanner(scanner_).word();
            const bool is_entity = std::ranges::count(entities, word, &Usage::word) > 0;
            if (!number_follows() && (!skips_words_ || is_entity)) return;
        }
    }

    /// Of an entity that may appear only once, the last counts.
    void note_repeated(std::string_view word, std::size_t offset,
                       std::optional<std::size_t>& last) {
        if (last) {
            mistakes_.note(statement_ignored, offset,
                           "a second '{}', which counts; keep one of them", word);
        }
        last = offset;
    }

    bool read_view(std::size_t offset) {
        note_repeated("v", offset, view_);
        std::array<std::optional<std::size_t>, std::size(view_parts)> places;
        const std::size_t before = mistakes_.count();
        while (scanner_.find_word()) {
            const auto part =
                std::ranges::find(view_parts, LineScanner(scanner_).word(), &Usage::word);
            if (part == std::end(view_parts)) break;
            note_repeated(part->word, scanner_.offset(), places[part - std::begin(view_parts)]);
            scanner_.word();
            usage_ = part->usage;
            if (!read_view_part(part->word)) return false;
        }
        for (std::size_t i = 0; i < 4; ++i) {  // the others are optional
            if (places[i]) continue;
            mistakes_.add(offset, "the view has no '{}'; add {}", view_parts[i].word,
                          view_parts[i].usage);
        }
        if (mistakes_.count() != before) return true;
        const Scene::Camera& camera = scene_.camera;
        if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
            mistakes_.add(*places[mistake->is_up ? 2 : 1], "{}", mistake->message);
        }
        return true;
    }

    bool read_view_part(std::string_view part) {
        if (part == "from") return assign(read_vec3(part), scene_.camera.from);
        if (part == "at") return assign(read_vec3(part), scene_.camera.at);
        if (part == "up") return assign(read_vec3(part), scene_.camera.up);
        if (part == "hither") return read_next(part).has_value();
        const std::size_t offset = next_offset();
        if (part == "angle") {
            const auto degrees = read_next(part);
            if (degrees && !(*degrees > 0 && *degrees < 180)) {
                mistakes_.add(offset, "angle is {}; write an angle between 0 and 180", *degrees);
            }
            scene_.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical,
                                           degrees.value_or(0)};
            return degrees.has_value();
        }
        const auto width = read_integer(part, 1, max_image_side);
        const auto height = width ? read_integer(part, 1, max_image_side) : std::nullopt;
        if (!height) return false;
        scene_.width = *width;
        scene_.height = *height;
        const auto pixels = static_cast<std::int64_t>(*width) * *height;
        if (pixels > max_image_pixels) {
            mistakes_.add(offset, "the picture has {} pixels; make it {} at most", pixels,
                          max_image_pixels);
        }
        return true;
    }

    static bool assign(const std::optional<glm::dvec3>& value, glm::dvec3& target) {
        if (value) target = *value;
        return value.has_value();
    }

    bool read_background(std::size_t offset) {
        note_repeated("b", offset, background_);
        return assign(read_color("background"), scene_.background);
    }

    bool read_light() {
        const auto position = read_vec3("light position");
        if (!position) return false;
        Scene::Light light;
        light.position = *position;
        light.has_own_intensity =
            number_follows() && assign(read_color("light color"), light.intensity);
        scene_.lights.push_back(light);
        return true;
    }

    /// Numbers that are missing or wrong are those of the default.
    bool read_fill() {
        constexpr const char* names[] = {"red", "green", "blue", "Kd", "Ks", "Shine", "T", "ior"};
        remedy_ = &value_replaced;
        Fill fill = default_fill;
        std::array<std::size_t, 8> places{};
        for (std::size_t i = 0; i < fill.size(); ++i) {
            places[i] = next_offset();
            const bool there = number_follows();
            const auto number = read_next(names[i]);
            if (!there) break;
            if (number) fill[i] = at_least_0(*number, names[i], places[i]);
        }
        auto& [red, green, blue, kd, ks, shine, t, ior] = fill;
        if (t > 0 && ior == 0) {
            report(places[7], "ior is 0 where T is not; write an index above 0, 1 to go straight");
            ior = 1;
        }
        const double brightest = std::max({red, green, blue});
        if (brightest * kd > max_reflectance) {
            kd = at_most(brightest * kd, "Kd times the color", places[3]) / brightest;
        }
        ks = at_most(ks, "Ks", places[4]);
        t = at_most(t, "T", places[6]);
        use(fill);
        return true;
    }

    /// red green blue Kd Ks Shine T ior
    using Fill = std::array<double, 8>;
    static constexpr Fill default_fill = {1, 1, 1, 1, 0, 0, 0, 1};

    void use(const Fill& fill) {
        const auto next = static_cast<int>(scene_.materials.size());
        const auto [known, is_new] = fills_.try_emplace(fill, next);
        material_ = known->second;
        if (!is_new) return;
        const auto [red, green, blue, kd, ks, shine, t, ior] = fill;
        Scene::Material material;
        material.name = fmt::format("f{}", next + 1);
        material.diffuse = material.ambient = glm::dvec3(red, green, blue) * kd;
        material.specular = material.mirror = glm::dvec3(ks, ks, ks);
        material.shininess = shine;
        material.transmission = glm::dvec3(t, t, t);
        material.ior = t > 0 ? ior : 1;
        material.two_sided = true;
        scene_.materials.push_back(material);
    }

    /// The current material; matte white before the first f.
    int material() {
        if (material_ < 0) use(default_fill);
        return material_;
    }

    bool read_sphere() {
        const auto center = read_vec3("center");
        const std::size_t offset = next_offset();
        const auto radius = center ? read_next("radius") : std::nullopt;
        if (!radius) return false;
        if (*radius == 0) {
            report(offset, "radius is 0; write a larger one");
        } else {
            scene_.spheres.push_back({*center, std::abs(*radius), material()});
        }
        return true;
    }

    bool read_cone(std::size_t offset) {
        const auto base = read_vec3("base");
        const auto base_radius = base ? read_next("base radius") : std::nullopt;
        const auto apex = base_radius ? read_vec3("apex") : std::nullopt;
        const auto apex_radius = apex ? read_next("apex radius") : std::nullopt;
        if (!apex_radius) return false;
        const double one = *base_radius, other = *apex_radius;
        if (nearly_same_point(*base, *apex)) {
            report(offset, same_cone_ends);
        } else if (one == 0 && other == 0) {
            report(offset, zero_cone_radii);
        } else if (std::min(one, other) < 0 && std::max(one, other) > 0) {
            report(offset, "the radii have opposite signs; give both the same sign");
        } else {
            scene_.cones.push_back({*base, *apex, std::abs(one), std::abs(other), material()});
        }
        return true;
    }

    bool read_polygon(bool is_patch) {
        const std::size_t offset = next_offset();
        const auto count = read_integer("vertex count", 3, 1 << 30);
        if (!count) return false;
        const std::size_t least_bytes = is_patch ? 12 : 6;  // of a vertex
        if (static_cast<std::size_t>(*count) > (scanner_.bytes_left() + 1) / least_bytes) {
            report(offset, fmt::format("vertex count is {}, and the rest of the file is too short "
                                       "for so many; write how many follow",
                                       *count));
            return false;
        }
        corners_.clear();
        normals_.clear();
        for (int i = 0; i < *count; ++i) {
            const auto corner = read_vec3("vertex");
            const std::size_t normal_offset = corner && is_patch ? next_offset() : 0;
            const auto normal = corner && is_patch ? read_vec3("normal") : std::nullopt;
            if (!corner || (is_patch && !normal)) return false;
            corners_.push_back(*corner);
            const auto unit = normal ? unit_direction(*normal) : std::nullopt;
            if (unit) normals_.push_back(*unit);
            if (normal && !unit) {
                mistakes_.note(made_flat, normal_offset,
                               "a vertex normal is zero; give it a direction");
            }
        }
        const bool smooth = normals_.size() == corners_.size();
        if (const auto* blemish =
                split_polygon(corners_, polygon_work(mistakes_.text().size()), parts_)) {
            has_lost_ = true;
            mistakes_.note(blemish->remedy, offset, "{}", blemish->message);
        }
        for (const auto& [a, b, c] : parts_) {
            Scene::Triangle triangle{{corners_[a], corners_[b], corners_[c]}, {}, material()};
            if (smooth) triangle.normals = {normals_[a], normals_[b], normals_[c]};
            if (!zero_area(triangle.vertices)) scene_.triangles.push_back(triangle);
        }
        return true;
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

    LineScanner scanner_;
    Mistakes mistakes_;
    Scene scene_;
    std::string_view usage_;                        ///< the syntax of the entity being read
    const Remedy* remedy_ = nullptr;                ///< for it, if it cannot be read
    std::optional<std::size_t> view_, background_;  ///< their offsets
    std::map<Fill, int> fills_;                     ///< equal ones share a material
    int material_ = -1;                             ///< -1: no fill yet
    std::vector<glm::dvec3> corners_, normals_;     ///< of the polygon at hand
    std::vector<std::array<std::uint32_t, 3>> parts_;
    bool skips_words_ = false;
    bool has_lost_ = false;  ///< a shape, or a statement that may be one
};

}  // namespace

Scene parse_nff_scene(std::string_view text, const std::string& file_name) {
    Scene scene = NffReader(text, file_name).read();
    scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
