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

/// A word, and how many numbers follow it at least.
struct Statement {
    std::string_view word, usage;
    std::size_t numbers;
    const Remedy* remedy;  ///< if they cannot be read; null: an error
};

/// The view and its parts, of which the first four are required; then the others.
constexpr Statement statements[] = {
    {"v", "v, then from, at, up and angle", 0, nullptr},
    {"from", "from x y z", 3, nullptr},
    {"at", "at x y z", 3, nullptr},
    {"up", "up x y z", 3, nullptr},
    {"angle", "angle degrees", 1, nullptr},
    {"hither", "hither distance", 1, nullptr},
    {"resolution", "resolution width height", 2, nullptr},
    {"b", "b red green blue", 3, &statement_ignored},
    {"l", "l x y z, with red green blue or without", 3, &statement_ignored},
    {"f", "f red green blue Kd Ks Shine T ior", 8, &value_replaced},
    {"c", "c base x y z radius apex x y z radius (numbers only)", 8, &left_out},
    {"s", "s x y z radius", 4, &left_out},
    {"p", "p count, then count times x y z", 1, &left_out},
    {"pp", "pp count, then count times x y z nx ny nz", 1, &left_out}};

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
            read_statement() ? skip_numbers() : skip_to_statement();
            if (shape_count() > max_nff_primitives) {
                throw Error(ExitCode::limit,
                            fmt::format("{}: more than {} primitives; split the scene",
                                        mistakes_.file_name(), max_nff_primitives));
            }
        }
        check_view();
        mistakes_.throw_if_any();
        if (shape_count() == 0 && has_lost_) mistakes_.refuse_notes();
        set_light();
        scene_.notes = mistakes_.notes();
        return std::move(scene_);
    }

   private:
    static constexpr std::size_t at = 2, up = 3, background = 7;  // places among the statements

    std::size_t shape_count() const {
        return scene_.spheres.size() + scene_.cones.size() + scene_.triangles.size();
    }

    /// The statement that a word begins; null if there is none. A view's parts follow each other.
    const Statement* find(std::string_view word) const {
        const Statement* const found = std::ranges::find(statements, word, &Statement::word);
        const bool is_part = found > statements && found < statements + background;
        return found == std::end(statements) || (is_part && !in_view_) ? nullptr : found;
    }

    bool read_statement() {
        offset_ = scanner_.offset();
        const std::string_view word = scanner_.word();
        statement_ = find(word);
        in_view_ = statement_ && statement_ < statements + background;
        if (!statement_) return note_unknown(word);
        note_repeated();
        numbers_.clear();
        return (read_numbers(statement_->numbers) || word == "f") && use_numbers(word);
    }

    bool note_unknown(std::string_view word) {
        has_lost_ = true;
        if (word == "nff" && !places_[0]) {
            mistakes_.add(offset_,
                          "unknown entity 'nff'; this is Sense8's NFF, a different format");
        } else {
            mistakes_.note(statement_ignored, offset_,
                           "unknown entity {}; NFF has v, b, l, f, c, s, p and pp; "
                           "extensions are not supported",
                           in_quotes(word));
        }
        return false;
    }

    /// Of the view, each of its parts and the background, the last counts.
    void note_repeated() {
        const auto which = static_cast<std::size_t>(statement_ - statements);
        if (which > background) return;
        if (places_[which]) {
            mistakes_.note(statement_ignored, offset_,
                           "a second '{}', which counts; keep one of them", statement_->word);
        }
        if (which == 0) std::fill_n(places_.begin(), background, std::nullopt);
        places_[which] = offset_;
    }

    /// Notes what is wrong with the statement at hand, or in a view adds it to the errors.
    void report(std::size_t offset, std::string message) {
        has_lost_ = has_lost_ || statement_->remedy == &left_out;
        mistakes_.report(statement_->remedy, offset, std::move(message));
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

    /// Reads so many more. Reports one that is missing or wrong; a wrong one of a fill is the
    /// default's.
    bool read_numbers(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            if (!number_follows()) {
                const std::string_view word = LineScanner(scanner_).word();
                report(scanner_.offset(),
                       fmt::format("expected a number, found {}; write {}",
                                   word.empty() ? "the end" : in_quotes(word), statement_->usage));
                return false;
            }
            const std::size_t offset = scanner_.offset();
            const auto number = scan_number(scanner_, "a number", mistakes_, statement_->remedy);
            const bool is_fill = statement_->remedy == &value_replaced;
            has_lost_ = has_lost_ || (!number && statement_->remedy == &left_out);
            if (!number && !is_fill) return false;
            numbers_.push_back({number ? *number : default_fill[i], offset});
        }
        return true;
    }

    glm::dvec3 vec3(std::size_t first) const {
        return {numbers_[first].value, numbers_[first + 1].value, numbers_[first + 2].value};
    }

    double at_least_0(double number, std::size_t offset) {
        if (number >= 0) return number;
        mistakes_.note(value_replaced, offset, "a number is {}; write 0 or more", number);
        return 0;
    }

    /// A negative channel is 0.
    glm::dvec3 color(std::size_t first) {
        glm::dvec3 color = vec3(first);
        for (int i = 0; i < 3; ++i) color[i] = at_least_0(color[i], numbers_[first].offset);
        return color;
    }

    /// The i-th number may be missing.
    double at_most(double number, std::string_view name, std::size_t i) {
        if (number <= max_reflectance) return number;
        const std::size_t offset = numbers_[std::min(i, numbers_.size() - 1)].offset;
        mistakes_.note(value_replaced, offset, "{} is {}; write {} at most", name, number,
                       max_reflectance);
        return max_reflectance;
    }

    /// Whether it is a whole number in the range; else reports it.
    bool is_whole(std::size_t i, std::string_view name, int low, int high) {
        const double number = numbers_[i].value;
        if (number >= low && number <= high && number == std::floor(number)) return true;
        report(numbers_[i].offset, fmt::format("{} is {}; write a whole number from {} to {}", name,
                                               number, low, high));
        return false;
    }

    void skip_numbers() {
        while (number_follows()) {
            const std::size_t offset = scanner_.offset();
            mistakes_.note(number_ignored, offset,
                           "{} is one number too many, or an entity's letter is "
                           "missing",
                           in_quotes(scanner_.word()));
            in_view_ = false;
        }
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
        if (word == "angle") read_angle();
        if (word == "resolution") return read_resolution();
        if (word == "b") scene_.background = color(0);
        if (word == "l") read_light();
        if (word == "f") read_fill();
        if (word == "c") read_cone();
        if (word == "s") read_sphere();
        if (word == "p" || word == "pp") return read_polygon(word == "pp");
        return true;
    }

    void read_angle() {
        const double degrees = numbers_[0].value;
        if (!(degrees > 0 && degrees < 180)) {
            report(numbers_[0].offset,
                   fmt::format("angle is {}; write an angle between 0 and 180", degrees));
        }
        scene_.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, degrees};
    }

    bool read_resolution() {
        for (const std::size_t i : {0, 1}) {
            if (!is_whole(i, "resolution", 1, max_image_side)) return false;
        }
        scene_.width = static_cast<int>(numbers_[0].value);
        scene_.height = static_cast<int>(numbers_[1].value);
        const auto pixels = static_cast<std::int64_t>(scene_.width) * scene_.height;
        if (pixels > max_image_pixels) {
            report(numbers_[0].offset, fmt::format("the picture has {} pixels; make it {} at most",
                                                   pixels, max_image_pixels));
        }
        return true;
    }

    void check_view() {
        if (!places_[0])
            mistakes_.add(0, "the file has no view; add v with from, at, up and angle");
        if (mistakes_.count() > 0) return;
        for (std::size_t i = 1; i <= 4; ++i) {
            if (places_[i]) continue;
            mistakes_.add(*places_[0], "the view has no '{}'; add {}", statements[i].word,
                          statements[i].usage);
        }
        if (mistakes_.count() > 0) return;
        const Scene::Camera& camera = scene_.camera;
        if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
            mistakes_.add(*places_[mistake->is_up ? up : at], "{}", mistake->message);
        }
    }

    void read_light() {
        Scene::Light light;
        light.position = vec3(0);
        light.has_own_intensity = number_follows() && read_numbers(3);
        if (light.has_own_intensity) light.intensity = color(3);
        scene_.lights.push_back(light);
    }

    /// Numbers that are missing are those of the default.
    void read_fill() {
        Fill fill = default_fill;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            fill[i] = at_least_0(numbers_[i].value, numbers_[i].offset);
        }
        auto& [red, green, blue, kd, ks, shine, t, ior] = fill;
        if (t > 0 && ior == 0) {
            report(numbers_[7].offset,
                   "ior is 0 where T is not; write an index above 0, 1 to go straight");
            ior = 1;
        }
        const double brightest = std::max({red, green, blue});
        if (brightest * kd > max_reflectance) {
            kd = at_most(brightest * kd, "Kd times the color", 3) / brightest;
        }
        ks = at_most(ks, "Ks", 4);
        t = at_most(t, "T", 6);
        use(fill);
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

    void read_sphere() {
        const double radius = std::abs(numbers_[3].value);
        if (radius == 0) {
            report(numbers_[3].offset, "radius is 0; write a larger one");
        } else {
            scene_.spheres.push_back({vec3(0), radius, material()});
        }
    }

    void read_cone() {
        const glm::dvec3 base = vec3(0), apex = vec3(4);
        const double one = numbers_[3].value, other = numbers_[7].value;
        if (nearly_same_point(base, apex)) {
            report(offset_, same_cone_ends);
        } else if (one == 0 && other == 0) {
            report(offset_, zero_cone_radii);
        } else if (std::min(one, other) < 0 && std::max(one, other) > 0) {
            report(offset_, "the radii have opposite signs; give both the same sign");
        } else {
            scene_.cones.push_back({base, apex, std::abs(one), std::abs(other), material()});
        }
    }

    bool read_polygon(bool is_patch) {
        if (!is_whole(0, "vertex count", 3, 1 << 30)) return false;
        const std::size_t offset = numbers_[0].offset, each = is_patch ? 6 : 3;
        const auto count = static_cast<std::size_t>(numbers_[0].value);
        if (count > (scanner_.bytes_left() + 1) / (2 * each)) {
            report(offset, fmt::format("vertex count is {}, and the rest of the file is too short "
                                       "for so many; write how many follow",
                                       count));
            return false;
        }
        if (!read_numbers(count * each)) return false;
        corners_.clear();
        normals_.clear();
        for (std::size_t i = 1; i < numbers_.size(); i += each) {
            corners_.push_back(vec3(i));
            if (!is_patch) continue;
            if (const auto unit = unit_direction(vec3(i + 3))) {
                normals_.push_back(*unit);
            } else {
                mistakes_.note(made_flat, numbers_[i + 3].offset,
                               "a vertex normal is zero; give it a direction");
            }
        }
        const bool smooth = normals_.size() == corners_.size();
        if (const auto* blemish = split_polygon(corners_, mistakes_.text().size(), parts_)) {
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

    struct Number {
        double value;
        std::size_t offset;
    };

    LineScanner scanner_;
    Mistakes mistakes_;
    Scene scene_;
    const Statement* statement_ = nullptr;  ///< being read
    std::size_t offset_ = 0;                ///< of it
    std::vector<Number> numbers_;           ///< of it
    bool in_view_ = false;                  ///< it is a view or a part of one
    /// Of the view, its parts and the background.
    std::array<std::optional<std::size_t>, background + 1> places_;
    std::map<Fill, int> fills_;                  ///< equal ones share a material
    int material_ = -1;                          ///< -1: no fill yet
    std::vector<glm::dvec3> corners_, normals_;  ///< of the polygon at hand
    std::vector<std::array<std::uint32_t, 3>> parts_;
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
