// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/scene/geometry.h"
#include "host/scene/mesh.h"
#include "host/scene/scene.h"
#include "host/scene/words.h"

namespace rt {
namespace {

double brightest(const glm::dvec3& color) { return std::max({color.r, color.g, color.b}); }

bool has_shapes(const Scene& scene) {
    return !scene.spheres.empty() || !scene.cones.empty() || triangle_count(scene) > 0;
}

/// Whether any surface can appear lit.
bool anything_shines(const Scene& scene) {
    const auto lit = [](const Scene::Light& light) { return brightest(light.intensity) > 0; };
    const bool lights = std::ranges::any_of(scene.lights, lit);
    return std::ranges::any_of(scene.materials, [&](const Scene::Material& m) {
        const bool ambient = brightest(m.ambient * scene.ambient_light) > 0;
        const bool direct = lights && brightest(m.diffuse + m.specular) > 0;
        const bool mirrored =
            brightest(scene.background) > 0 && brightest(m.mirror + m.transmission) > 0;
        return ambient || direct || mirrored;
    });
}

/// Whether the shapes' bounding box lies behind the eye or beyond one side of the window. The
/// sides are planes through the eye, or for an orthographic camera parallel to its view.
bool nothing_in_view(const Scene& scene) {
    const Scene::Camera& camera = scene.camera;
    const glm::dvec3 forward = unit_direction(camera.at - camera.from).value_or(glm::dvec3(0));
    const glm::dvec3 sideways = glm::cross(forward, camera.up);
    const glm::dvec3 right = unit_direction(sideways).value_or(glm::dvec3(0));
    const glm::dvec3 up = glm::cross(right, forward);
    const auto [low, high] = bounding_box(scene);
    bool outside[5] = {true, true, true, true, true};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1 ? high : low).x, (corner & 2 ? high : low).y,
                           (corner & 4 ? high : low).z);
        const glm::dvec3 to = p - camera.from;
        const double depth = glm::dot(to, forward), x = glm::dot(to, right), y = glm::dot(to, up);
        const double scale = camera.projection == Scene::Projection::perspective ? depth : 1;
        const Scene::Window& w = camera.window;
        const bool beyond[5] = {depth<0, x> w.right * scale, x<w.left * scale, y> w.top * scale,
                                y < w.bottom * scale};
        for (int i = 0; i < 5; ++i) outside[i] = outside[i] && beyond[i];
    }
    return std::ranges::any_of(outside, [](bool all) { return all; });
}

/// Whether all channels are integers, and one is too large for light.
bool is_of_bytes(const glm::dvec3& color) {
    const bool whole =
        color == glm::dvec3(std::floor(color.r), std::floor(color.g), std::floor(color.b));
    return whole && brightest(color) > 16 && brightest(color) <= 255;
}

using NamedColor = Named<glm::dvec3 Scene::Material::*>;

/// "diffuse of material 'red'", the first color that satisfies `is`; "" if none does.
template <typename Is>
std::string first_where(const Scene& scene, std::span<const NamedColor> colors, Is is) {
    for (const Scene::Material& material : scene.materials) {
        for (const auto& [key, color] : colors) {
            if (is(material.*color)) {
                return fmt::format("{} of material {}", key, in_quotes(material.name));
            }
        }
    }
    return "";
}

}  // namespace

Box bounding_box(const Scene& scene) {
    Box box;
    const auto add = [&](const glm::dvec3& p, double radius = 0) {
        box = {glm::min(box.low, p - radius), glm::max(box.high, p + radius)};
    };
    for (const Scene::Sphere& sphere : scene.spheres) add(sphere.center, sphere.radius);
    for (const Scene::Cone& cone : scene.cones) {
        add(cone.base, cone.base_radius);
        add(cone.apex, cone.apex_radius);
    }
    for (const Scene::Triangle& triangle : scene.triangles) {
        for (const glm::dvec3& vertex : triangle.vertices) add(vertex);
    }
    for (const Scene::Mesh& mesh : scene.meshes) {
        const Box faces = bounding_box(mesh);
        box = {glm::min(box.low, faces.low), glm::max(box.high, faces.high)};
    }
    return box;
}

std::vector<std::string> scene_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    if (has_shapes(scene) && !anything_shines(scene)) {
        warnings.emplace_back(
            "no light reaches any surface, so all of them are black; add lights, or ambient light "
            "and ambient colors");
    }
    if (has_shapes(scene) && scene.path.keys.empty() && nothing_in_view(scene)) {
        warnings.emplace_back(
            "nothing is in view; check the camera's from, at, and angle or window");
    }
    const std::span<const NamedColor> all(material_colors);
    std::string found = first_where(scene, all, is_of_bytes);
    if (found.empty() && is_of_bytes(scene.background)) found = "background";
    if (!found.empty()) {
        warnings.push_back(found +
                           ": looks like 0 to 255, but colors range from 0 to 1; divide by 255");
        return warnings;
    }
    const auto brightens = [](const glm::dvec3& color) { return brightest(color) > 1; };
    found = first_where(scene, all.subspan(3), brightens);  // mirror and transmission
    if (!found.empty()) {
        warnings.push_back(found + ": exceeds 1, so light grows at each bounce; use at most 1");
    }
    return warnings;
}

}  // namespace rt
