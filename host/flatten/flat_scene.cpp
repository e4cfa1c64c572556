// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "host/error.h"
#include "host/flatten/view_frame.h"

namespace rt {

namespace {

bool is_black(const glm::dvec3& color) { return color == glm::dvec3(0); }

template <typename T>
typename Flat<T>::Packed3 pack(const glm::dvec3& v) {
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

/// Squares of distances must stay finite in T.
template <typename T>
constexpr double farthest = sizeof(T) == sizeof(float) ? 0x1p60 : 0x1p500;

template <typename T>
typename Flat<T>::Packed3 pack_position(const ViewFrame& view, const glm::dvec3& scene_point) {
    const glm::dvec3 p = view.to_view(scene_point);
    if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > farthest<T>) {
        throw Error(ExitCode::input,
                    fmt::format("({:g}, {:g}, {:g}) lies more than {:g} times as far away as most "
                                "of the scene; move it nearer{}",
                                scene_point.x, scene_point.y, scene_point.z, farthest<T>,
                                sizeof(T) == sizeof(float) ? ", or use --precision double" : ""));
    }
    return pack<T>(p);
}

template <typename T>
typename Flat<T>::Sphere flatten_sphere(const ViewFrame& view, const Scene::Sphere& sphere) {
    typename Flat<T>::Sphere flat{};
    flat.center = pack_position<T>(view, sphere.center);
    flat.radius = static_cast<T>(sphere.radius * view.scale);
    flat.material = sphere.material;
    return flat;
}

/// How far a barycentric point may lie off the plane: 4 u extent + 6 u |vertex| per axis, seen
/// along the normal (after Pharr, Jakob and Humphreys, PBR 4th ed., 6.8.5; measured in
/// docs/numerics.md).
template <typename T>
double barycentric_offset(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                          const glm::dvec3& normal) {
    const glm::dvec3 low = glm::min(a, glm::min(b, c));
    const glm::dvec3 high = glm::max(a, glm::max(b, c));
    const glm::dvec3 largest = glm::max(glm::abs(low), glm::abs(high));
    const glm::dvec3 error = 4.0 * (high - low) + 6.0 * largest;
    return static_cast<double>(Flat<T>::roundoff) * glm::dot(glm::abs(normal), error);
}

template <typename T>
typename Flat<T>::Triangle flatten_triangle(const ViewFrame& view,
                                            const Scene::Triangle& triangle) {
    const glm::dvec3 a = view.to_view(triangle.vertices[0]);
    const glm::dvec3 b = view.to_view(triangle.vertices[1]);
    const glm::dvec3 c = view.to_view(triangle.vertices[2]);
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    typename Flat<T>::Triangle flat{};
    flat.p0 = pack_position<T>(view, triangle.vertices[0]);
    flat.p1 = pack_position<T>(view, triangle.vertices[1]);
    flat.p2 = pack_position<T>(view, triangle.vertices[2]);
    flat.material = triangle.material;
    flat.smooth = Flat<T>::none;
    flat.offset = static_cast<T>(barycentric_offset<T>(a, b, c, normal));
    flat.normal = pack<T>(normal);
    flat.plane = static_cast<T>(glm::dot(normal, a));
    return flat;
}

template <typename T>
typename Flat<T>::VertexNormals flatten_normals(const std::array<glm::dvec3, 3>& normals) {
    return {pack<T>(normals[0]), 0, pack<T>(normals[1]), 0, pack<T>(normals[2]), 0};
}

template <typename T>
typename Flat<T>::Material flatten_material(const Scene::Material& material) {
    typename Flat<T>::Material flat{};
    flat.ambient = pack<T>(material.ambient);
    flat.shininess = static_cast<T>(material.shininess);
    flat.diffuse = pack<T>(material.diffuse);
    flat.two_sided = material.two_sided ? 1 : 0;
    flat.specular = pack<T>(material.specular);
    flat.ior = static_cast<T>(material.ior);
    flat.mirror = pack<T>(material.mirror);
    flat.transmission = pack<T>(material.transmission);
    return flat;
}

/// Half a pixel's sides on the view plane. Pixels are square, to the last bit, unless the author
/// gave a window: else rays on a picture's diagonal would miss edges that lie there by 1e-16.
glm::dvec2 half_pixel(const Scene& scene, const Scene::Window& window) {
    using Fixed = Scene::FieldOfView::Fixed;
    const double x = (window.right - window.left) / (2.0 * scene.width);
    const double y = (window.top - window.bottom) / (2.0 * scene.height);
    switch (scene.camera.field_of_view.fixed) {
        case Fixed::window:
            return {x, y};
        case Fixed::horizontal:
        case Fixed::view_width:
            return {x, x};
        case Fixed::vertical:
        case Fixed::view_height:
            return {y, y};
    }
    return {x, y};
}

/// An adaptive mode begins with one sample a pixel.
template <typename Frame>
void set_sampling(const Scene& scene, Frame& frame) {
    frame.grid = scene.aa.pattern == AaMode::Pattern::sobol ? 0 : scene.aa.count;
    frame.samples = scene.aa.samples();
    frame.seed = scene.sampling_seed;
    switch (scene.filter) {
        case Filter::box:
            frame.filter = f32::RT_FILTER_BOX;
            break;
        case Filter::tent:
            frame.filter = f32::RT_FILTER_TENT;
            break;
        case Filter::gaussian:
            frame.filter = f32::RT_FILTER_GAUSSIAN;
            break;
        case Filter::mitchell:
            frame.filter = f32::RT_FILTER_MITCHELL;
            break;
    }
}

template <typename T>
typename Flat<T>::Frame flatten_frame(const ViewFrame& view, const Scene& scene) {
    const Scene::Window window = camera_window(scene.camera, scene.width, scene.height);
    const glm::dvec2 step = half_pixel(scene, window);
    const glm::dvec3 dx = view.right * step.x;
    const glm::dvec3 dy = view.up * step.y;
    typename Flat<T>::Frame frame{};
    if (scene.camera.projection == Scene::Projection::perspective) {
        frame.direction = pack<T>(view.forward + view.right * (0.5 * (window.left + window.right)) +
                                  view.up * (0.5 * (window.bottom + window.top)));
        frame.direction_dx = pack<T>(dx);
        frame.direction_dy = pack<T>(dy);
    } else {
        frame.direction = pack<T>(view.forward);
        frame.origin_dx = pack<T>(dx * view.scale);
        frame.origin_dy = pack<T>(dy * view.scale);
    }
    frame.width = scene.width;
    frame.height = scene.height;
    set_sampling(scene, frame);
    frame.max_bounces = scene.max_bounces;
    frame.background = pack<T>(scene.background);
    frame.ambient_light = pack<T>(scene.ambient_light);
    return frame;
}

/// The materials that some primitive wears.
std::vector<const Scene::Material*> worn_materials(const Scene& scene) {
    std::vector<bool> worn(scene.materials.size(), false);
    for (const auto& sphere : scene.spheres) worn[static_cast<std::size_t>(sphere.material)] = true;
    for (const auto& triangle : scene.triangles) {
        worn[static_cast<std::size_t>(triangle.material)] = true;
    }
    std::vector<const Scene::Material*> materials;
    for (std::size_t i = 0; i < worn.size(); ++i) {
        if (worn[i]) materials.push_back(&scene.materials[i]);
    }
    return materials;
}

bool reflects_light(const Scene::Material* material) {
    return !is_black(material->diffuse) || !is_black(material->specular);
}

bool is_mirror(const Scene::Material* material) { return !is_black(material->mirror); }

template <typename T>
void flatten_lights(const ViewFrame& view, const Scene& scene, FlatScene<T>& flat) {
    const auto materials = worn_materials(scene);
    if (std::none_of(materials.begin(), materials.end(), reflects_light)) return;
    for (const Scene::Light& light : scene.lights) {
        if (is_black(light.intensity)) continue;
        flat.lights.push_back(
            {pack_position<T>(view, light.position), 0, pack<T>(light.intensity), 0});
    }
}

template <typename T>
Features needed_features(const Scene& scene, const FlatScene<T>& flat) {
    const auto materials = worn_materials(scene);
    Features features;
    features.spheres = !flat.spheres.empty();
    features.triangles = !flat.triangles.empty();
    features.vertex_normals = !flat.vertex_normals.empty();
    features.lights = !flat.lights.empty();
    features.mirrors =
        scene.max_bounces > 0 && std::any_of(materials.begin(), materials.end(), is_mirror);
    return features;
}

/// Primitives are numbered in Flat<T>::Index, and so are the numbers of a film.
void check_counts(const Scene& scene) {
    const std::size_t limit = std::numeric_limits<std::int32_t>::max();
    const std::size_t count = scene.spheres.size() + scene.triangles.size();
    if (count > limit || scene.lights.size() > limit) {
        throw Error(ExitCode::limit, fmt::format("{} primitives and {} lights; at most {} of each "
                                                 "can be rendered",
                                                 count, scene.lights.size(), limit));
    }
}

}  // namespace

template <typename T>
std::size_t FlatScene<T>::bytes() const {
    return spheres.size() * sizeof(spheres[0]) + triangles.size() * sizeof(triangles[0]) +
           vertex_normals.size() * sizeof(vertex_normals[0]) +
           materials.size() * sizeof(materials[0]) + lights.size() * sizeof(lights[0]);
}

template <typename T>
FlatScene<T> flatten(const Scene& scene) {
    check_counts(scene);
    const ViewFrame view = make_view_frame(scene);
    FlatScene<T> flat;
    flat.spheres.reserve(scene.spheres.size());
    for (const auto& sphere : scene.spheres) {
        flat.spheres.push_back(flatten_sphere<T>(view, sphere));
    }
    flat.triangles.reserve(scene.triangles.size());
    for (const auto& triangle : scene.triangles) {
        flat.triangles.push_back(flatten_triangle<T>(view, triangle));
        if (!triangle.normals) continue;
        flat.triangles.back().smooth =
            static_cast<typename Flat<T>::Index>(flat.vertex_normals.size());
        flat.vertex_normals.push_back(flatten_normals<T>(*triangle.normals));
    }
    for (const auto& material : scene.materials) {
        flat.materials.push_back(flatten_material<T>(material));
    }
    flatten_lights(view, scene, flat);
    flat.frame = flatten_frame<T>(view, scene);
    flat.frame.sphere_count = static_cast<typename Flat<T>::Index>(flat.spheres.size());
    flat.frame.triangle_count = static_cast<typename Flat<T>::Index>(flat.triangles.size());
    flat.frame.light_count = static_cast<typename Flat<T>::Index>(flat.lights.size());
    flat.features = needed_features(scene, flat);
    return flat;
}

template struct FlatScene<float>;
template struct FlatScene<double>;
template FlatScene<float> flatten(const Scene&);
template FlatScene<double> flatten(const Scene&);

}  // namespace rt
