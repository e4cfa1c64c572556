// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_shapes.h"

#include <array>

#include "host/scene/geometry_checks.h"
#include "host/scene/json_reader.h"

namespace rt {
namespace {

constexpr std::string_view light_keys[] = {"position", "intensity"};
constexpr std::string_view sphere_keys[] = {"center", "radius", "material"};
constexpr std::string_view cone_keys[] = {"base", "base_radius", "apex", "apex_radius", "material"};
constexpr std::string_view triangle_keys[] = {"vertices", "normals", "material"};

using Corners = std::array<glm::dvec3, 3>;

void read_material_of(const ObjectReader& reader, const MaterialTable& materials, int& target) {
    const auto read = [&](const JsonValue& value, std::string_view name, Mistakes& mistakes) {
        return materials.read_reference(value, name, mistakes);
    };
    reader.required("material", "\"material\": \"name\"", target, read);
}

std::optional<Corners> read_corners(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes) {
    const auto* items = read_array(value, name, 3, mistakes);
    if (!items) return std::nullopt;
    Corners corners{};
    bool good = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto corner = read_vec3((*items)[i], name, mistakes);
        good = good && corner;
        if (corner) corners[i] = *corner;
    }
    if (!good) return std::nullopt;
    return corners;
}

std::optional<Corners> read_vertices(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes) {
    const auto vertices = read_corners(value, name, mistakes);
    if (!vertices || !zero_area(*vertices)) return vertices;
    mistakes.add(value.offset, "zero-area triangle; remove it");
    return std::nullopt;
}

std::optional<Corners> read_normals(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes) {
    auto normals = read_corners(value, name, mistakes);
    if (!normals) return std::nullopt;
    for (glm::dvec3& normal : *normals) {
        const auto unit = unit_direction(normal);
        if (!unit) {
            mistakes.add(value.offset,
                         "a vertex normal is zero; give it a direction or remove "
                         "'normals'");
            return std::nullopt;
        }
        normal = *unit;
    }
    return normals;
}

}  // namespace

Scene::Light read_light(const JsonValue& value, Mistakes& mistakes) {
    Scene::Light light;
    const ObjectReader reader(value, "a light", light_keys, mistakes);
    reader.required("position", "\"position\": [x, y, z]", light.position, read_vec3);
    reader.optional("intensity", light.intensity, read_color);
    light.has_own_intensity = reader.find("intensity") != nullptr;
    return light;
}

Scene::Sphere read_sphere(const JsonValue& value, const MaterialTable& materials,
                          Mistakes& mistakes) {
    Scene::Sphere sphere;
    const ObjectReader reader(value, "a sphere", sphere_keys, mistakes);
    reader.required("center", "\"center\": [x, y, z]", sphere.center, read_vec3);
    reader.required("radius", "\"radius\": 1", sphere.radius, read_positive);
    read_material_of(reader, materials, sphere.material);
    return sphere;
}

Scene::Cone read_cone(const JsonValue& value, const MaterialTable& materials, Mistakes& mistakes) {
    Scene::Cone cone;
    const ObjectReader reader(value, "a cone", cone_keys, mistakes);
    const std::size_t before = mistakes.count();
    reader.required("base", "\"base\": [x, y, z]", cone.base, read_vec3);
    reader.required("base_radius", "\"base_radius\": 1", cone.base_radius, read_not_negative);
    reader.required("apex", "\"apex\": [x, y, z]", cone.apex, read_vec3);
    reader.required("apex_radius", "\"apex_radius\": 0", cone.apex_radius, read_not_negative);
    if (mistakes.count() == before) {
        if (nearly_same_point(cone.base, cone.apex)) {
            mistakes.add(reader.find("apex")->offset, same_cone_ends);
        }
        if (cone.base_radius == 0 && cone.apex_radius == 0) {
            mistakes.add(reader.find("base_radius")->offset, zero_cone_radii);
        }
    }
    read_material_of(reader, materials, cone.material);
    return cone;
}

Scene::Triangle read_triangle(const JsonValue& value, const MaterialTable& materials,
                              Mistakes& mistakes) {
    Scene::Triangle triangle;
    const ObjectReader reader(value, "a triangle", triangle_keys, mistakes);
    reader.required("vertices", "\"vertices\": [[x, y, z], [x, y, z], [x, y, z]]",
                    triangle.vertices, read_vertices);
    reader.optional("normals", triangle.normals, read_normals);
    read_material_of(reader, materials, triangle.material);
    return triangle;
}

}  // namespace rt
