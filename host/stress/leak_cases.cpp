// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <random>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/meshes.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// Everything is the same gray, in front of a glaring blue background. A leak is a wrong pixel.
Scene gray_scene(int width, int height, int grid) {
    Scene scene = bare_scene();
    scene.aa.count = grid;
    scene.lights.clear();
    scene.ambient_light = glm::dvec3(1);
    scene.background = {0, 0, 4};
    set_image_size(scene, width, height);
    add_matt(scene, glm::dvec3(0.5));
    return scene;
}

/// The correct picture of such a scene: the inside of one big ball.
Scene all_gray(int width, int height, int grid) {
    Scene scene = gray_scene(width, height, grid);
    add_sphere(scene, scene.camera.from, 100, 0);
    return scene;
}

Scene inside_mesh(const StressMesh& mesh, glm::dvec3 eye, glm::dvec3 at, int grid) {
    Scene scene = gray_scene(160, 120, grid);
    add_mesh(scene, mesh, 0);
    set_view(scene, eye, at, 100);
    return scene;
}

void add_leak_case(StressFamily& family, const char* label, InQuick quick,
                   std::function<Scene()> scene) {
    StressCase one = picture_case(label, static_cast<double>(family.cases.size()), quick, scene);
    std::get<PictureTrial>(one.trial).reference_scene = [scene] {
        const Scene of = scene();
        return all_gray(of.width, of.height, 1);
    };
    one.tolerance.most_wrong_at_edges = 0;
    family.cases.push_back(std::move(one));
}

StressFamily inside_meshes() {
    StressFamily family{"mesh-from-inside",
                        "mesh",
                        "rays slip through between two triangles that "
                        "share an edge",
                        {}};
    add_leak_case(family, "bumpy-ball", InQuick::yes, [] {
        return inside_mesh(bumpy_mesh(2), {0.125, 0.0625, 0.25}, {0, 0, -1}, 2);
    });
    add_leak_case(family, "fan", InQuick::no, [] {
        return inside_mesh(fan_mesh(250), {0.0625, 0.125, 0.0625}, {0, 1, 0.001}, 2);
    });
    add_leak_case(family, "needles", InQuick::yes, [] {
        return inside_mesh(needle_mesh(12, 4, 1e-6), {0.0625, 0.125, 0.0625}, {0.25, 0.25, -1}, 2);
    });
    add_leak_case(family, "tiny-ball", InQuick::no, [] {
        return inside_mesh(placed(bumpy_mesh(2), 1e-6, {3, 2, 1}), {3, 2, 1},
                           {3 + 1e-6, 2 + 2e-7, 1}, 2);
    });
    add_leak_case(family, "far-ball", InQuick::no, [] {
        return inside_mesh(placed(bumpy_mesh(2), 1, {148376, 1234, -223423}),
                           {148376, 1234, -223423}, {148377, 1234.25, -223423}, 2);
    });
    return family;
}

/// A bumpy sheet over a lattice whose vertices and diagonals lie exactly on pixel rays.
Scene lattice_scene(int cells, bool perspective, double height, unsigned seed) {
    Scene scene = gray_scene(2 * cells, 2 * cells, 1);
    std::mt19937 engine(seed);
    std::uniform_int_distribution<int> level(-8, 8);
    const int n = cells + 3;
    std::vector<glm::dvec3> points;
    // `2 cells` pixels span as many units, so pixel centers lie at odd multiples of 0.5.
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double x = 2 * i - n + 0.5, y = 2 * j - n + 0.5;
            const double z = height * level(engine) / 8;
            const double along = perspective ? 1 + z / 64 : 1;
            points.push_back({x * along, y * along, perspective ? -64 * along + 64 : z});
        }
    }
    const auto at = [&](int i, int j) { return points[static_cast<std::size_t>(j * n + i)]; };
    for (int j = 0; j + 1 < n; ++j) {
        for (int i = 0; i + 1 < n; ++i) {
            add_quad(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), 0);
        }
    }
    if (perspective) {
        set_view(scene, {0, 0, 64}, {0, 0, 0}, 10);
        scene.camera.field_of_view.fixed = Scene::FieldOfView::Fixed::window;
        const double side = cells / 64.0;
        scene.camera.window = {-side, side, -side, side};
    } else {
        set_orthographic(scene, {0, 0, 64}, {0, 0, 0}, 2 * cells);
    }
    return scene;
}

StressFamily lattices() {
    StressFamily family{"on-pixel-rays",
                        "lattice",
                        "edge functions are 0 on vertices that lie on "
                        "the rays themselves",
                        {}};
    add_leak_case(family, "parallel-flat", InQuick::yes,
                  [] { return lattice_scene(16, false, 0, 1); });
    add_leak_case(family, "parallel-bumpy", InQuick::no,
                  [] { return lattice_scene(16, false, 2, 2); });
    add_leak_case(family, "perspective-flat", InQuick::no,
                  [] { return lattice_scene(16, true, 0, 3); });
    add_leak_case(family, "perspective-bumpy", InQuick::yes,
                  [] { return lattice_scene(16, true, 2, 4); });
    add_leak_case(family, "perspective-128x128", InQuick::no,
                  [] { return lattice_scene(64, true, 2, 5); });
    return family;
}

/// A wall of squares at several depths seen along an axis; rays run along the sides of BVH boxes.
Scene box_wall(int axis, bool rounded) {
    Scene scene = gray_scene(64, 64, 1);
    const double step = rounded ? 1.0 / 3 : 1;
    const int n = 10;
    const auto turned = [&](glm::dvec3 p) {
        return axis == 0 ? glm::dvec3(p.z, p.x, p.y) : (axis == 1 ? glm::dvec3(p.y, p.z, p.x) : p);
    };
    const auto face = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
        add_quad(scene, turned(a), turned(b), turned(c), turned(d), 0);
    };
    for (int j = -n; j < n; ++j) {
        for (int i = -n; i < n; ++i) {
            const double x0 = i * step, x1 = (i + 1) * step, y0 = j * step, y1 = (j + 1) * step;
            const double z = ((i * 7 + j * 3) % 4) * step / 2;
            face({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
        }
    }
    const double side = 16 * step;
    scene.camera.up = turned({0, 1, 0});
    set_orthographic(scene, turned({step / 8, step / 8, 8}), turned({step / 8, step / 8, 0}), side);
    return scene;
}

/// Pixel centers lie at multiples of a quarter of a square: every fourth exactly on a side.
StressFamily axis_parallel() {
    StressFamily family{"axis-parallel",
                        "axis",
                        "0 times infinity in the test of a box whose "
                        "side the ray runs in",
                        {}};
    add_leak_case(family, "z", InQuick::yes, [] { return box_wall(2, false); });
    add_leak_case(family, "x", InQuick::no, [] { return box_wall(0, false); });
    add_leak_case(family, "y", InQuick::no, [] { return box_wall(1, false); });
    add_leak_case(family, "z-thirds", InQuick::no, [] { return box_wall(2, true); });
    return family;
}

}  // namespace

void add_leak_families(StressFamilies& families) {
    families.push_back(inside_meshes());
    families.push_back(lattices());
    families.push_back(axis_parallel());
}

}  // namespace rt
