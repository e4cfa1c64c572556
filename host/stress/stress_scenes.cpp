// SPDX-License-Identifier: Apache-2.0
#include "host/stress/stress_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace rt {

namespace {

/// Calls change(point) for every point of the scene, including the camera's.
template <typename Change>
void for_each_point(Scene& scene, const Change& change) {
    change(scene.camera.from);
    change(scene.camera.at);
    for (auto& light : scene.lights) change(light.position);
    for (auto& sphere : scene.spheres) change(sphere.center);
    for (auto& cone : scene.cones) {
        change(cone.base);
        change(cone.apex);
    }
    for (auto& triangle : scene.triangles) {
        for (auto& vertex : triangle.vertices) change(vertex);
    }
}

Scene::Mesh icosahedron() {
    const double g = std::numbers::phi;
    Scene::Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (auto& vertex : mesh.positions) vertex = glm::normalize(vertex);
    return mesh;
}

Scene::Mesh cut_in_four(Scene::Mesh mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] = middles.try_emplace(
            std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
            mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
        }
        return entry->second;
    };
    std::vector<Scene::Mesh::Face> faces;
    for (const auto& [a, b, c] : mesh.faces) {
        const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        faces.insert(faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
    return mesh;
}

/// Hubs above and below a rim at these angles.
Scene::Mesh hubs_and_rim(const std::vector<double>& angles) {
    Scene::Mesh mesh;
    mesh.positions = {{0, 1, 0}, {0, -1, 0}};
    for (const double angle : angles) {
        mesh.positions.push_back({std::cos(angle), 0, -std::sin(angle)});
    }
    const auto count = static_cast<std::uint32_t>(angles.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % count;
        mesh.faces.push_back({0, a, b});
        mesh.faces.push_back({1, b, a});
    }
    return mesh;
}

int add_material(Scene& scene, const Scene::Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

}  // namespace

void set_view(Scene& scene, glm::dvec3 from, glm::dvec3 at, double fov_degrees) {
    scene.camera.projection = Scene::Projection::perspective;
    scene.camera.from = from;
    scene.camera.at = at;
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, fov_degrees};
    set_image_size(scene, scene.width, scene.height);
}

void set_orthographic(Scene& scene, glm::dvec3 from, glm::dvec3 at, double height) {
    set_view(scene, from, at, height);
    scene.camera.projection = Scene::Projection::orthographic;
    scene.camera.field_of_view.fixed = Scene::FieldOfView::Fixed::view_height;
    set_image_size(scene, scene.width, scene.height);
}

int add_matt(Scene& scene, glm::dvec3 color, double specular, double shininess) {
    Scene::Material material;
    material.ambient = color;
    material.diffuse = color;
    material.specular = glm::dvec3(specular);
    material.shininess = shininess;
    return add_material(scene, material);
}

int add_mirror(Scene& scene, double mirror, double ambient) {
    Scene::Material material;
    material.ambient = glm::dvec3(ambient);
    material.mirror = glm::dvec3(mirror);
    return add_material(scene, material);
}

int add_glass(Scene& scene, double ior, double transmission, double mirror, double ambient) {
    const int material = add_mirror(scene, mirror, ambient);
    scene.materials.back().transmission = glm::dvec3(transmission);
    scene.materials.back().ior = ior;
    return material;
}

void add_sphere(Scene& scene, glm::dvec3 center, double radius, int material) {
    scene.spheres.push_back({center, radius, material});
}

void add_triangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, int material) {
    scene.triangles.push_back({{a, b, c}, {}, material});
}

void add_cone(Scene& scene, glm::dvec3 base, double base_radius, glm::dvec3 apex,
              double apex_radius, int material) {
    scene.cones.push_back({base, apex, base_radius, apex_radius, material});
}

void add_quad(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d, int material) {
    add_triangle(scene, a, b, c, material);
    add_triangle(scene, a, c, d, material);
}

void add_floor(Scene& scene, glm::dvec3 center, double half_side, int material) {
    const double h = half_side;
    add_quad(scene, center + glm::dvec3(-h, 0, h), center + glm::dvec3(h, 0, h),
             center + glm::dvec3(h, 0, -h), center + glm::dvec3(-h, 0, -h), material);
}

void add_box(Scene& scene, glm::dvec3 low, glm::dvec3 high, int material) {
    Scene::Mesh box = box_mesh();
    for (auto& p : box.positions) p = glm::mix(low, high, glm::greaterThan(p, glm::dvec3(0)));
    add_mesh(scene, box, material);
}

Scene bare_scene(int width, int height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.aa.pattern = AaMode::Pattern::grid;
    scene.aa.count = 1;
    scene.max_bounces = 5;
    scene.background = {0.25, 0.375, 0.5};
    scene.ambient_light = glm::dvec3(0.25);
    scene.lights = {{{-3, 6, 4}, glm::dvec3(0.5)}, {{5, 4, 2}, {0.375, 0.3125, 0.25}}};
    set_view(scene, {0, 2, 8}, {0, 0.75, 0}, 40);
    return scene;
}

Scene scene_to_aim_at(double distance,
                      const std::function<void(Scene&, const glm::dvec3& middle)>& add_shape) {
    Scene scene = bare_scene();
    const int skin = add_matt(scene, glm::dvec3(0.5));
    const glm::dvec3 towards(-0.48, 0.6, -0.64);
    add_shape(scene, distance * towards);
    for (int i = 0; i < 3; ++i) add_sphere(scene, {0.125 * i, 0, 1}, 0x1p-10, skin);
    set_view(scene, glm::dvec3(0), towards, 60);
    return scene;
}

Scene still_life() {
    Scene scene = bare_scene();
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const int green = add_matt(scene, {0.125, 0.625, 0.25}, 0.25, 200);
    const int gray = add_matt(scene, glm::dvec3(0.5), 0.125, 10);
    const int glossy = add_matt(scene, {0.25, 0.25, 0.75});
    scene.materials[static_cast<std::size_t>(glossy)].mirror = glm::dvec3(0.25);
    scene.materials[static_cast<std::size_t>(gray)].mirror = glm::dvec3(0.125);
    const int mirror = add_mirror(scene, 0.75);
    add_sphere(scene, {-1.5, 1, 0}, 1, red);
    add_sphere(scene, {0.75, 0.75, 1}, 0.75, mirror);
    add_sphere(scene, {2.25, 0.5, 2}, 0.5, glossy);
    add_sphere(scene, {-0.25, 0.375, 2.5}, 0.375, green);
    add_floor(scene, {0, 0, 0}, 12, gray);
    const glm::dvec3 tip(2, 2.25, -1.5);
    const std::array<glm::dvec3, 4> base{{{1, 0, -0.5}, {3, 0, -0.5}, {3, 0, -2.5}, {1, 0, -2.5}}};
    for (std::size_t i = 0; i < 4; ++i) {
        add_triangle(scene, base[i], base[(i + 1) % 4], tip, i % 2 == 0 ? green : glossy);
    }
    return scene;
}

Scene glass_still_life() {
    Scene scene = still_life();
    const int clear = add_glass(scene, 1.5, 0.875, 0.0625);
    const int heavy = add_glass(scene, 2.5, 0.75);
    const int orange = add_matt(scene, {0.875, 0.5, 0.125});
    scene.materials.back().two_sided = true;
    scene.spheres[2].material = heavy;
    scene.spheres[3].material = clear;
    add_sphere(scene, {-1, 0.5, 4}, 0.5, clear);
    add_box(scene, {0.5, 0.0625, 3.5}, {1.25, 0.5, 4}, clear);
    add_cone(scene, {-3, 0, 2}, 0.5, {-2.75, 1.25, 2}, 0, orange);
    add_cone(scene, {3, 0, 3.5}, 0.375, {3.25, 1, 3}, 0.375, 4);
    add_cone(scene, {-0.25, 2.25, -1}, 0.25, {0.5, 2.75, -0.5}, 0.625, orange);
    return scene;
}

Scene scaled(Scene scene, double factor) {
    for_each_point(scene, [&](glm::dvec3& point) { point *= factor; });
    for (auto& sphere : scene.spheres) sphere.radius *= factor;
    for (auto& cone : scene.cones) {
        cone.base_radius *= factor;
        cone.apex_radius *= factor;
    }
    if (scene.camera.projection == Scene::Projection::orthographic) {
        scene.camera.field_of_view.amount *= factor;
        set_image_size(scene, scene.width, scene.height);
    }
    return scene;
}

Scene shifted(Scene scene, glm::dvec3 by) {
    for_each_point(scene, [&](glm::dvec3& point) { point += by; });
    return scene;
}

Scene::Mesh ball_mesh(int times) {
    Scene::Mesh mesh = icosahedron();
    for (int i = 0; i < times; ++i) mesh = cut_in_four(std::move(mesh));
    return mesh;
}

Scene::Mesh bumpy_mesh(int times) {
    Scene::Mesh mesh = ball_mesh(times);
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> radius(0.8, 1.2);
    for (auto& vertex : mesh.positions) vertex *= radius(engine);
    return mesh;
}

Scene::Mesh fan_mesh(int spokes) {
    std::vector<double> angles;
    for (int i = 0; i < spokes; ++i) angles.push_back(2 * std::numbers::pi * i / spokes);
    return hubs_and_rim(angles);
}

Scene::Mesh needle_mesh(int clusters, int needles, double gap) {
    std::vector<double> angles;
    for (int i = 0; i < clusters; ++i) {
        for (int j = 0; j <= needles; ++j) {
            angles.push_back(2 * std::numbers::pi * i / clusters + gap * j);
        }
    }
    return hubs_and_rim(angles);
}

Scene::Mesh wedge_mesh(double degrees) {
    const double half = degrees * std::numbers::pi / 360, x = std::cos(half), y = std::sin(half);
    Scene::Mesh mesh;
    mesh.positions = {{0, 0, -1}, {x, -y, -1}, {x, y, -1}, {0, 0, 1}, {x, -y, 1}, {x, y, 1}};
    mesh.faces = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                  {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return mesh;
}

Scene::Mesh box_mesh() {
    Scene::Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back({(i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1});
    }
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

Scene::Mesh placed(Scene::Mesh mesh, double scale, glm::dvec3 to) {
    for (auto& vertex : mesh.positions) vertex = scale * vertex + to;
    return mesh;
}

void add_mesh(Scene& scene, const Scene::Mesh& mesh, int material) {
    const auto& points = mesh.positions;
    for (const auto& [a, b, c] : mesh.faces) {
        add_triangle(scene, points[a], points[b], points[c], material);
    }
}

}  // namespace rt
