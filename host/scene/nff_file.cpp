// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
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

/// A word, and how many numbers follow it at least.
struct Statement {
    std::string_view word, usage;
    std::size_t numbers;
};

/// The view and its required parts come first.
constexpr Statement statements[] = {{"v", "v, then from, at, up and angle", 0},
                                    {"from", "from x y z", 3},
                                    {"at", "at x y z", 3},
                                    {"up", "up x y z", 3},
                                    {"angle", "angle degrees", 1},
                                    {"hither", "hither distance", 1},
                                    {"resolution", "resolution width height", 2},
                                    {"b", "b red green blue", 3},
                                    {"l", "l x y z, with red green blue or without", 3},
                                    {"f", "f red green blue Kd Ks Shine T ior", 8},
                                    {"c", "c base x y z radius apex x y z radius", 8},
                                    {"s", "s x y z radius", 4},
                                    {"p", "p count, then count times x y z", 1},
                                    {"pp", "pp count, then count times x y z nx ny nz", 1}};

/// Lines have no meaning: numbers and words are separated by blanks and line ends.
class NffReader {
   public:
    NffReader(std::string_view text, const std::string& file_name)
        : scanner_(text), mistakes_(text, file_name) {
        scene_.width = scene_.height = nff_side;
        scene_.max_bounces = nff_bounces;
    }

    Scene read() {
        while (scanner_.find_word()) {
            if (!read_statement()) skip_to_statement();
            if (shape_count() > max_nff_primitives) {
                throw Error(ExitCode::limit,
                            fmt::format("{}: more than {} primitives; split the scene",
                                        mistakes_.file_name(), max_nff_primitives));
            }
        }
        check_view();
        mistakes_.throw_if_any();
        if (shape_count() == 0) mistakes_.refuse_notes();
        set_light();
        scene_.notes = mistakes_.notes();
        return std::move(scene_);
    }

   private:
    static constexpr std::size_t at = 2, up = 3, view_parts = 5;  // places among the statements

    std::size_t shape_count() const {
        return scene_.spheres.size() + scene_.cones.size() + scene_.triangles.size();
    }

    static const Statement* find(std::string_view word) {
        const Statement* const found = std::ranges::find(statements, word, &Statement::word);
        return found == std::end(statements) ? nullptr : found;
    }

    /// Returns whether it could be read; of those that the file has once, the last counts.
    bool read_statement() {
        offset_ = scanner_.offset();
        const std::string_view word = scanner_.word();
        statement_ = find(word);
        if (!statement_) {
            mistakes_.note(statement_ignored, offset_,
                           "unknown entity {}; NFF has v, b, l, f, c, s, p and pp; "
                           "extensions are not supported",
                           in_quotes(word));
            return false;
        }
        const auto which = static_cast<std::size_t>(statement_ - statements);
        if (which < view_parts) places_[which] = offset_;
        numbers_.clear();
        return read_numbers(statement_->numbers) && use_numbers(word);
    }

    /// Adds what is wrong with the statement at hand to the errors.
    template <typename... Args>
    bool refuse(fmt::format_string<Args...> message, Args&&... args) {
        mistakes_.add(offset_, message, std::forward<Args>(args)...);
        return false;
    }

    bool number_follows() const {
        LineScanner ahead = scanner_;
        return ahead.find_word() && ahead.number();
    }

    /// Reads so many more.
    bool read_numbers(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            scanner_.find_word();
            const std::size_t offset = scanner_.offset();
            const auto number = scanner_.number();
            if (!number || std::abs(*number) > max_scene_number) {
                mistakes_.add(offset, "a number is {}; write {}, from -1e30 to 1e30",
                              found_text(scanner_, number), statement_->usage);
                return false;
            }
            numbers_.push_back(*number);
        }
        return true;
    }

    glm::dvec3 vec3(std::size_t first) const {
        return {numbers_[first], numbers_[first + 1], numbers_[first + 2]};
    }

    /// Whether the numbers from this one on are at least 0; else reports it.
    bool are_not_negative(std::size_t first) {
        const double least = std::ranges::min(std::span(numbers_).subspan(first));
        return least >= 0 || refuse("a number is {}; write 0 or more", least);
    }

    /// Whether it is a whole number in the range; else reports it.
    bool is_whole(double number, std::string_view name, int low, int high) {
        if (number >= low && number <= high && number == std::floor(number)) return true;
        return refuse("{} is {}; write a whole number from {} to {}", name, number, low, high);
    }

    bool at_line_start() const {
        const std::string_view before = mistakes_.text().substr(0, scanner_.offset());
        const std::size_t last = before.find_last_not_of(" \t\v\f");
        return last == before.npos || before[last] == '\n' || before[last] == '\r';
    }

    /// Error recovery: skips to a line that begins with a statement. Those of an extension may
    /// begin with words of their own.
    void skip_to_statement() {
        if (scanner_.find_word() && !at_line_start()) scanner_.next_line();
        while (scanner_.find_word() && !find(LineScanner(scanner_).word())) scanner_.next_line();
    }

    bool use_numbers(std::string_view word) {
        Scene::Camera& camera = scene_.camera;
        if (word == "from") camera.from = vec3(0);
        if (word == "at") camera.at = vec3(0);
        if (word == "up") camera.up = vec3(0);
        if (word == "angle") return read_angle();
        if (word == "resolution") return read_resolution();
        if (word == "b") {
            scene_.background = vec3(0);
            return are_not_negative(0);
        }
        if (word == "l") return read_light();
        if (word == "f") return read_fill();
        if (word == "c") read_cone();
        if (word == "s") read_sphere();
        if (word == "p" || word == "pp") return read_polygon(word == "pp");
        return true;
    }

    bool read_angle() {
        const double degrees = numbers_[0];
        scene_.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, degrees};
        return (degrees > 0 && degrees < 180) ||
               refuse("angle is {}; write an angle between 0 and 180", degrees);
    }

    bool read_resolution() {
        for (const double side : numbers_) {
            if (!is_whole(side, "resolution", 1, max_image_side)) return false;
        }
        scene_.width = static_cast<int>(numbers_[0]);
        scene_.height = static_cast<int>(numbers_[1]);
        const double pixels = numbers_[0] * numbers_[1];
        return pixels <= max_image_pixels ||
               refuse("the picture has {} pixels; make it {} at most", pixels, max_image_pixels);
    }

    void check_view() {
        if (mistakes_.count() > 0) return;
        for (std::size_t i = 0; i < view_parts; ++i) {
            if (places_[i]) continue;
            mistakes_.add(places_[0].value_or(0), "the file has no '{}'; add {}",
                          statements[i].word, statements[i].usage);
            return;
        }
        const Scene::Camera& camera = scene_.camera;
        if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
            mistakes_.add(*places_[mistake->is_up ? up : at], "{}", mistake->message);
        }
    }

    bool read_light() {
        Scene::Light light;
        light.position = vec3(0);
        light.has_own_intensity = number_follows();
        if (light.has_own_intensity) {
            if (!read_numbers(3) || !are_not_negative(3)) return false;
            light.intensity = vec3(3);
        }
        scene_.lights.push_back(light);
        return true;
    }

    /// red green blue Kd Ks Shine T ior
    using Fill = std::array<double, 8>;

    bool read_fill() {
        if (!are_not_negative(0)) return false;
        Fill fill{};
        std::ranges::copy(numbers_, fill.begin());
        const auto [red, green, blue, kd, ks, shine, t, ior] = fill;
        if (t > 0 && ior == 0) {
            return refuse("ior is 0 where T is not; write an index above 0, 1 to go straight");
        }
        const double most = std::max({red * kd, green * kd, blue * kd, ks, t});
        if (most > max_reflectance) {
            return refuse("a weight, or Kd times the color, is {}; write {} at most", most,
                          max_reflectance);
        }
        use(fill);
        return true;
    }

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
        if (material_ < 0) use({1, 1, 1, 1, 0, 0, 0, 1});
        return material_;
    }

    void leave_out(const char* why) { mistakes_.note(left_out, offset_, "{}", why); }

    void read_sphere() {
        const double radius = std::abs(numbers_[3]);
        if (radius == 0) return leave_out("radius is 0; write a larger one");
        scene_.spheres.push_back({vec3(0), radius, material()});
    }

    void read_cone() {
        const glm::dvec3 base = vec3(0), apex = vec3(4);
        const double one = numbers_[3], other = numbers_[7];
        if (nearly_same_point(base, apex)) return leave_out(same_cone_ends);
        if (one == 0 && other == 0) return leave_out(zero_cone_radii);
        if (std::min(one, other) < 0 && std::max(one, other) > 0) {
            return leave_out("the radii have opposite signs; give both the same sign");
        }
        scene_.cones.push_back({base, apex, std::abs(one), std::abs(other), material()});
    }

    bool read_polygon(bool is_patch) {
        if (!is_whole(numbers_[0], "vertex count", 3, 1 << 30)) return false;
        const std::size_t each = is_patch ? 6 : 3;
        const auto count = static_cast<std::size_t>(numbers_[0]);
        if (count > (scanner_.bytes_left() + 1) / (2 * each)) {
            return refuse(
                "vertex count is {}, and the rest of the file is too short for so many; write how "
                "many follow",
                count);
        }
        if (!read_numbers(count * each)) return false;
        corners_.clear();
        normals_.clear();
        for (std::size_t i = 1; i < numbers_.size(); i += each) {
            corners_.push_back(vec3(i));
            if (!is_patch) continue;
            const auto unit = unit_direction(vec3(i + 3));
            if (!unit) return refuse("a vertex normal is zero; give it a direction");
            normals_.push_back(*unit);
        }
        if (const auto* blemish = split_polygon(corners_, mistakes_.text().size(), parts_)) {
            mistakes_.note(blemish->remedy, offset_, "{}", blemish->message);
        }
        for (const auto& [a, b, c] : parts_) {
            Scene::Triangle triangle{{corners_[a], corners_[b], corners_[c]}, {}, material()};
            if (is_patch) triangle.normals = {normals_[a], normals_[b], normals_[c]};
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
    const Statement* statement_ = nullptr;                       ///< being read
    std::size_t offset_ = 0;                                     ///< of it
    std::vector<double> numbers_;                                ///< of it
    std::array<std::optional<std::size_t>, view_parts> places_;  ///< of the view and its parts
    std::map<Fill, int> fills_;                                  ///< equal ones share a material
    int material_ = -1;                                          ///< -1: no fill yet
    std::vector<glm::dvec3> corners_, normals_;                  ///< of the polygon at hand
    std::vector<std::array<std::uint32_t, 3>> parts_;
};

}  // namespace

Scene parse_nff_scene(std::string_view text, const std::string& file_name) {
    Scene scene = NffReader(text, file_name).read();
    scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
