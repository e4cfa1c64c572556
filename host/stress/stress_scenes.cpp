// SPDX-License-Identifier: Apache-2.0
#include "host/stress/stress_scenes.h"

#include <algorithm>

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

}  // namespace

void set_view(Scene& scene, glm::dvec3 from, glm::dvec3 at, double fov_degrees) {
    scene.camera.projection = Scene::Projection::perspective;
    scene.camera.from = from;
    scene.camera.at = at;
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, fov_degrees};
    set_image_size(scene, scene.width, scene.height);
}

void set_orthographic(Scene& scene, glm::dvec3 from, glm::dvec3 at, double height) {
    scene.camera.projection = Scene::Projection::orthographic;
    scene.camera.from = from;
    scene.camera.at = at;
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::view_height, height};
    set_image_size(scene, scene.width, scene.height);
}

int add_matt(Scene& scene, glm::dvec3 color, double specular, double shininess) {
    Scene::Material material;
    material.ambient = color;
    material.diffuse = color;
    material.specular = glm::dvec3(specular);
    material.shininess = shininess;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

int add_mirror(Scene& scene, double mirror, double ambient) {
    Scene::Material material;
    material.ambient = glm::dvec3(ambient);
    material.mirror = glm::dvec3(mirror);
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
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
    const auto corner = [&](int i) {
        return glm::dvec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    };
    for (const auto& [a, b, c, d] : std::array<std::array<int, 4>, 6>{{{0, 2, 3, 1},
                                                                       {4, 5, 7, 6},
                                                                       {0, 1, 5, 4},
                                                                       {2, 6, 7, 3},
                                                                       {0, 4, 6, 2},
                                                                       {1, 3, 7, 5}}}) {
        add_quad(scene, corner(a), corner(b), corner(c), corner(d), material);
    }
}

Scene bare_scene() {
    Scene scene;
    scene.width = 160;
    scene.height = 120;
    scene.aa.pattern = AaMode::Pattern::grid;
    scene.aa.count = 1;
    scene.max_bounces = 5;
    scene.background = {0.25, 0.375, 0.5};
    scene.ambient_light = glm::dvec3(0.25);
    scene.lights = {{{-3, 6, 4}, glm::dvec3(0.5)}, {{5, 4, 2}, {0.375, 0.3125, 0.25}}};
    set_view(scene, {0, 2, 8}, {0, 0.75, 0}, 40);
    return scene;
}

Scene shape_scene(double fov_degrees) {
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    add_matt(scene, {0.75, 0.5, 0.25}, 0.25, 20);
    scene.materials.back().two_sided = true;
    scene.lights = {{{0.25, 0.5, 0.5}, glm::dvec3(0.5)}};
    set_view(scene, {0, 0, 1}, {0, 0, 0}, std::min(120.0, fov_degrees));
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

}  // namespace rt
