// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_view.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "host/scene/geometry_checks.h"
#include "host/scene/scene_limits.h"

namespace rt {
namespace {

enum Part { from, at, up, angle, hither, resolution, part_count };

struct PartName {
    std::string_view word, usage;
    bool required;
};

constexpr PartName part_names[part_count] = {
    {"from", "from x y z", true},
    {"at", "at x y z", true},
    {"up", "up x y z", true},
    {"angle", "angle degrees", true},
    {"hither", "hither distance", false},
    {"resolution", "resolution width height", false},
};

/// The offset of each part of the view in the file.
using Places = std::array<std::optional<std::size_t>, part_count>;

std::optional<Part> part_called(std::string_view word) {
    for (int part = 0; part < part_count; ++part) {
        if (part_names[part].word == word) return static_cast<Part>(part);
    }
    return std::nullopt;
}

bool assign(const std::optional<glm::dvec3>& value, glm::dvec3& target) {
    if (value) target = *value;
    return value.has_value();
}

bool read_angle(NffTokens& tokens, Scene::Camera& camera, Mistakes& mistakes) {
    const std::size_t offset = tokens.peek().offset;
    const auto degrees = tokens.read_number("angle");
    if (!degrees) return false;
    if (*degrees > 0 && *degrees < 180) {
        camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, *degrees};
    } else {
        mistakes.add(offset,
                     fmt::format("angle is {}; write an angle between 0 and 180", *degrees));
    }
    return true;
}

bool read_resolution(NffTokens& tokens, Scene& scene, Mistakes& mistakes) {
    const std::size_t offset = tokens.peek().offset;
    const auto width = tokens.read_integer("resolution", 1, max_image_side);
    const auto height = width ? tokens.read_integer("resolution", 1, max_image_side) : std::nullopt;
    if (!height) return false;
    scene.width = *width;
    scene.height = *height;
    const auto pixels = static_cast<std::int64_t>(*width) * *height;
    if (pixels > max_image_pixels) {
        mistakes.add(offset, fmt::format("the picture has {} pixels; make it {} at most", pixels,
                                         max_image_pixels));
    }
    return true;
}

bool read_part(Part part, NffTokens& tokens, Scene& scene, Mistakes& mistakes) {
    switch (part) {
        case from:
            return assign(tokens.read_vec3("from"), scene.camera.from);
        case at:
            return assign(tokens.read_vec3("at"), scene.camera.at);
        case up:
            return assign(tokens.read_vec3("up"), scene.camera.up);
        case angle:
            return read_angle(tokens, scene.camera, mistakes);
        case hither:
            return tokens.read_number("hither").has_value();
        case resolution:
            return read_resolution(tokens, scene, mistakes);
        case part_count:
            break;
    }
    return false;
}

void note_missing(const Places& places, std::size_t offset, Mistakes& mistakes) {
    for (int part = 0; part < part_count; ++part) {
        if (places[part] || !part_names[part].required) continue;
        mistakes.add(offset, fmt::format("the view has no '{}'; add {}", part_names[part].word,
                                         part_names[part].usage));
    }
}

}  // namespace

bool read_nff_view(NffTokens& tokens, std::size_t offset, Scene& scene, Mistakes& mistakes) {
    Places places;
    const std::size_t before = mistakes.count();
    while (const auto part = part_called(tokens.peek().text)) {
        const NffToken word = tokens.take();
        if (places[*part]) {
            mistakes.add(word.offset, fmt::format("the view has a second '{}', first at {}; keep "
                                                  "one of them",
                                                  word.text, mistakes.place(*places[*part])));
        }
        places[*part] = word.offset;
        tokens.expect(part_names[*part].usage);
        if (!read_part(*part, tokens, scene, mistakes)) return false;
    }
    note_missing(places, offset, mistakes);
    if (mistakes.count() != before) return true;
    const Scene::Camera& camera = scene.camera;
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        mistakes.add(*places[mistake->is_up ? up : at], mistake->message);
    }
    return true;
}

}  // namespace rt
