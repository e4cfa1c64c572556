// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <type_traits>
#include <vector>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/scene/geometry.h"
#include "host/scene/mesh.h"
#include "host/scene/words.h"

namespace rt {

namespace {

/// Half the extent at distance 1 from the eye that a full angle spans.
double half_extent(double degrees) { return std::tan(degrees * (std::numbers::pi / 360.0)); }

Scene::Window centered(double half_width, double half_height) {
    return {-half_width, half_width, -half_height, half_height};
}

using Key = Scene::CameraPath::Key;

/// Adds `factor` times `slope` times the way from one camera to another to the numbers that are
/// interpolated.
void add_way(Scene::Camera& view, double factor, double slope, const Scene::Camera& start,
             const Scene::Camera& end) {
    view.from += factor * (slope * (end.from - start.from));
    view.at += factor * (slope * (end.at - start.at));
    view.up += factor * (slope * (end.up - start.up));
    const double amount = end.field_of_view.amount - start.field_of_view.amount;
    view.field_of_view.amount += factor * (slope * amount);
}

/// Between keys[i] and the next: a straight line, or a cubic Hermite curve with the tangents of
/// Catmull and Rom 1974, for unequal key spacing. Where the camera stands still it is the same to
/// the last bit.
Scene::Camera between(const std::vector<Key>& keys, std::size_t i, double share, bool is_smooth) {
    const double frames = keys[i + 1].frame - keys[i].frame;
    const double s = share, rest = 1 - share;
    const Key &start = keys[i], &end = keys[i + 1];
    Scene::Camera view = start.camera;
    add_way(view, is_smooth ? s * s * (3 - 2 * s) : s, 1, start.camera, end.camera);
    const auto add_tangent = [&](double factor, std::size_t at) {
        const Key& before = keys[at == 0 ? 0 : at - 1];
        const Key& after = keys[std::min(at + 1, keys.size() - 1)];
        const double slope = frames / (after.frame - before.frame);
        add_way(view, factor, slope, before.camera, after.camera);
    };
    if (is_smooth) {
        add_tangent(s * rest * rest, i);
        add_tangent(-s * s * rest, i + 1);
    }
    // Splines and rounding overshoot; the field of view must not.
    const double one = start.camera.field_of_view.amount, other = end.camera.field_of_view.amount;
    double& amount = view.field_of_view.amount;
    amount = std::clamp(amount, std::min(one, other), std::max(one, other));
    return view;
}

}  // namespace

Scene::Window camera_window(const Scene::Camera& camera, int width, int height) {
    using Fixed = Scene::FieldOfView::Fixed;
    const double amount = camera.field_of_view.amount;
    const auto from_width = [&](double half) { return centered(half, half * height / width); };
    const auto from_height = [&](double half) { return centered(half * width / height, half); };
    switch (camera.field_of_view.fixed) {
        case Fixed::window:
            break;
        case Fixed::horizontal:
            return from_width(half_extent(amount));
        case Fixed::vertical:
            return from_height(half_extent(amount));
        case Fixed::view_width:
            return from_width(amount / 2);
        case Fixed::view_height:
            return from_height(amount / 2);
    }
    return camera.window;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = scene.triangles.size();
    for (const Scene::Mesh& mesh : scene.meshes) count += mesh.faces.size();
    return count;
}

void set_image_size(Scene& scene, int width, int height) {
    scene.width = width;
    scene.height = height;
    scene.camera.window = camera_window(scene.camera, width, height);
}

std::string name_of_file(const std::string& path) {
    return printable(std::filesystem::path(path).stem().string());
}

Scene::Camera camera_at(const Scene& scene, double frame) {
    const std::vector<Key>& keys = scene.path.keys;
    if (keys.empty()) {
        throw Error(ExitCode::input, scene.name +
                                         ": no camera path; add \"path\" to the scene "
                                         "(docs/scene-format.md), or leave out --frames");
    }
    const auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                                       [](double f, const Key& key) { return f < key.frame; });
    if (next == keys.begin()) return keys.front().camera;
    if (next == keys.end()) return keys.back().camera;
    const auto i = static_cast<std::size_t>(next - keys.begin()) - 1;
    const double share = (frame - keys[i].frame) / (next->frame - keys[i].frame);
    if (share == 0) return keys[i].camera;
    const Scene::Camera camera = between(keys, i, share, scene.path.is_smooth);
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        throw Error(ExitCode::input, fmt::format("{}: the camera's path at frame {}: {}",
                                                 scene.name, frame, mistake->message));
    }
    return camera;
}

namespace {

// Every struct is taken apart by a structured binding, so that a new member does not compile until
// somebody has decided whether it is part of the hash.
class SceneHasher {
   public:
    template <typename... Parts>
    void add(const Parts&... parts) {
        (add_one(parts), ...);
    }

    std::uint64_t value() const { return hasher_.value(); }

   private:
    template <typename N>
    requires(std::is_arithmetic_v<N> || std::is_enum_v<N>) void add_one(N number) {
        if constexpr (std::is_enum_v<N>) {
            hasher_.add(static_cast<int>(number));
        } else {
            hasher_.add(number);
        }
    }
    template <typename Item>
    void add_one(const std::vector<Item>& items) {
        hasher_.add(items.size());
        for (const Item& item : items) add_one(item);
    }
    template <typename Item>
    void add_one(const std::array<Item, 3>& items) {
        for (const Item& item : items) add_one(item);
    }
    void add_one(const glm::dvec3& v) { add(v.x, v.y, v.z); }

    void add_one(const Scene::Camera& camera) {
        const auto& [projection, from, at, up, field_of_view, window] = camera;
        const auto& [fixed, amount] = field_of_view;
        const auto& [left, right, bottom, top] = window;
        add(projection, from, at, up, fixed);
        if (fixed == Scene::FieldOfView::Fixed::window) {
            add(left, right, bottom, top);
        } else {
            add(amount);
        }
    }
    void add_one(const Scene::Material& material) {
        const auto& [name, ambient, diffuse, specular, mirror, transmission, shininess, ior,
                     two_sided] = material;
        add(ambient, diffuse, specular, mirror, transmission, shininess, ior, two_sided);
    }
    void add_one(const Scene::Light& light) {
        const auto& [position, intensity, has_own_intensity] = light;
        add(position, intensity);
    }
    void add_one(const Scene::Sphere& sphere) {
        const auto& [center, radius, material] = sphere;
        add(center, radius, material);
    }
    void add_one(const Scene::Triangle& triangle) {
        const auto& [vertices, normals, material] = triangle;
        add(vertices, normals.has_value());
        if (normals) add(*normals);
        add(material);
    }
    void add_one(const Scene::Cone& cone) {
        const auto& [base, apex, base_radius, apex_radius, material] = cone;
        add(base, apex, base_radius, apex_radius, material);
    }
    void add_one(const Scene::Mesh& mesh) {
        const auto& [positions, normals, faces, face_normals, face_materials] = mesh;
        add(positions, normals, faces, face_normals, face_materials);
    }

    Hasher hasher_;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    const auto& [name, camera, path, width, height, aa, filter, sampling_seed, max_bounces,
                 background, ambient_light, lights, materials, spheres, cones, triangles, meshes,
                 notes, model_files] = scene;
    SceneHasher hasher;
    hasher.add(camera, background, ambient_light, lights, materials, spheres, cones, triangles,
               meshes);
    return hasher.value();
}

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
