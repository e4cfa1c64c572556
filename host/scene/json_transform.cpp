// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "host/scene/json_meshes.h"
#include "host/scene/json_reader.h"

namespace rt {
namespace {

constexpr std::string_view transform_keys[] = {"scale", "rotate_degrees", "translate"};

/// [x, y, z], or one number for all three.
std::optional<glm::dvec3> read_scale(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes) {
    std::optional<glm::dvec3> scale;
    if (value.as<double>()) {
        if (const auto number = read_number(value, name, mistakes)) scale = glm::dvec3(*number);
    } else {
        scale = read_vec3(value, name, mistakes);
    }
    if (!scale || (scale->x != 0 && scale->y != 0 && scale->z != 0)) return scale;
    mistakes.add(value.offset, "scale contains a 0; write other numbers");
    return std::nullopt;
}

std::optional<Affine> read_steps(const JsonValue& value, Mistakes& mistakes) {
    glm::dvec3 scale(1), degrees(0), translation(0);
    const ObjectReader reader(value, "the transform", transform_keys, mistakes);
    reader.optional("scale", scale, read_scale);
    reader.optional("rotate_degrees", degrees, read_vec3);
    reader.optional("translate", translation, read_vec3);
    return make_affine(scale, degrees, translation);
}

std::optional<Affine> read_matrix(const JsonValue& value, const JsonValue::Array& items,
                                  std::string_view name, Mistakes& mistakes) {
    std::array<double, 16> m{};
    if (items.size() != m.size()) {
        mistakes.add(value.offset, fmt::format("{} has {} items; write 16 of them, row by row",
                                               name, items.size()));
        return std::nullopt;
    }
    bool good = true;
    for (std::size_t i = 0; i < m.size(); ++i) {
        const auto number = read_number(items[i], name, mistakes);
        good = good && number;
        m[i] = number.value_or(0);
    }
    if (!good) return std::nullopt;
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        mistakes.add(items[12].offset,
                     "the last row of the transform is not 0, 0, 0, 1; write "
                     "the matrix row by row, the translation in column 4");
        return std::nullopt;
    }
    Affine affine;
    for (int row = 0; row < 3; ++row) {
        const std::size_t first = static_cast<std::size_t>(row) * 4;
        for (int column = 0; column < 3; ++column) {
            affine.linear[column][row] = m[first + static_cast<std::size_t>(column)];
        }
        affine.translation[row] = m[first + 3];
    }
    return affine;
}

}  // namespace

std::optional<Affine> read_transform(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes) {
    const auto* items = value.as<JsonValue::Array>();
    const auto affine =
        items ? read_matrix(value, *items, name, mistakes) : read_steps(value, mistakes);
    if (!affine || normal_matrix(affine->linear)) return affine;
    mistakes.add(value.offset,
                 "the transform is singular and flattens the mesh; correct its "
                 "numbers");
    return std::nullopt;
}

}  // namespace rt
