// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

enum class Copy { same, other_diagonal, turned, reversed_order };

/// A slanted square twice, in different colors: the first in the scene is visible.
Scene duplicate_square(Copy copy) {
    Scene scene = bare_scene();
    const int first = add_matt(scene, {0.875, 0.25, 0.125});
    const int second = add_matt(scene, {0.125, 0.25, 0.875});
    for (auto& material : scene.materials) material.two_sided = true;
    const glm::dvec3 a(-2, 0, 1.25), b(2.25, 0.125, 0.5), d(-1.75, 2, -1.125);
    const glm::dvec3 c = b + d - a;
    add_quad(scene, a, b, c, d, first);
    switch (copy) {
        case Copy::same:
            add_quad(scene, a, b, c, d, second);
            break;
        case Copy::other_diagonal:
            add_quad(scene, b, c, d, a, second);
            break;
        case Copy::turned:
            add_triangle(scene, b, c, a, second);
            add_triangle(scene, d, a, c, second);
            break;
        case Copy::reversed_order:
            add_triangle(scene, c, b, a, second);
            add_triangle(scene, d, c, a, second);
            break;
    }
    add_floor(scene, {0, -0.5, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    return scene;
}

/// What is visible of it: only the first square.
Scene single_square() {
    Scene scene = duplicate_square(Copy::same);
    scene.triangles.erase(scene.triangles.begin() + 2, scene.triangles.begin() + 4);
    return scene;
}

/// Two coplanar squares that share a quarter, where the first is visible.
Scene overlapping_squares(bool cut) {
    Scene scene = bare_scene();
    const int first = add_matt(scene, {0.875, 0.25, 0.125});
    const int second = add_matt(scene, {0.125, 0.25, 0.875});
    const auto at = [](double x, double y) { return glm::dvec3(x, y, 0.5 - 0.25 * x + 0.125 * y); };
    const auto square = [&](double x0, double y0, double x1, double y1, int material) {
        add_quad(scene, at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1), material);
    };
    square(-2, -0.5, 0.5, 1.5, first);
    if (cut) {
        square(0.5, 0.5, 2, 2.5, second);
        square(-1, 1.5, 0.5, 2.5, second);
    } else {
        square(-1, 0.5, 2, 2.5, second);
    }
    return scene;
}

Scene duplicate_tube() {
    Scene scene = bare_scene();
    const int first = add_matt(scene, {0.875, 0.25, 0.125});
    const int second = add_matt(scene, {0.125, 0.25, 0.875});
    for (auto& material : scene.materials) material.two_sided = true;
    add_cone(scene, {-1, 0, 0.5}, 0.75, {1.5, 1.5, -0.5}, 0.5, first);
    add_cone(scene, {-1, 0, 0.5}, 0.75, {1.5, 1.5, -0.5}, 0.5, second);
    add_cone(scene, {1.5, 1.5, -0.5}, 0.5, {-1, 0, 0.5}, 0.75, second);
    return scene;
}

Scene single_tube() {
    Scene scene = duplicate_tube();
    scene.cones.resize(1);
    return scene;
}

Scene duplicate_ball(double moved) {
    Scene scene = bare_scene();
    const int first = add_matt(scene, {0.875, 0.25, 0.125});
    add_sphere(scene, {0, 1, 0}, 1, first);
    add_sphere(scene, {moved, 1, 0}, 1, add_matt(scene, {0.125, 0.25, 0.875}));
    add_floor(scene, {0, 0, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    return scene;
}

/// Two identical squares so close together that they count as one: the lower, first in the scene,
/// is visible and must not be shadowed by the other.
Scene two_sheets() {
    Scene scene = bare_scene();
    const int matt = add_matt(scene, {0.875, 0.5, 0.125});
    for (const double y : {0.0, 5e-6}) {
        add_quad(scene, {-0.5, y, 0.5}, {0.5, y, 0.5}, {0.5, y, -0.5}, {-0.5, y, -0.5}, matt);
    }
    set_view(scene, {0, 4, 3}, {0, 0, 0}, 20);
    return scene;
}

/// Many copies of one triangle and one ball: one of each is visible, and the others do no harm.
Scene pile(int count) {
    Scene scene = bare_scene(8, 6);
    const int first = add_matt(scene, {0.875, 0.25, 0.125});
    const int rest = add_matt(scene, {0.125, 0.25, 0.875});
    scene.lights.resize(1);
    for (int i = 0; i < count / 2; ++i) {
        const int material = i == 0 ? first : rest;
        add_triangle(scene, {-2, 0, 0.5}, {2, 0.25, 0.25}, {0, 2.5, -0.5}, material);
        add_sphere(scene, {0, 1, -2}, 1.5, material);
    }
    return scene;
}

/// Triangles that cross each other and balls, with edges in faces.
Scene crossing_scene() {
    Scene scene = bare_scene();
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const int blue = add_matt(scene, {0.125, 0.25, 0.875});
    const int mirror = add_mirror(scene, 0.75);
    for (auto& material : scene.materials) material.two_sided = true;
    add_triangle(scene, {-3, 0, 1}, {3, 0.5, -1}, {0, 3, 0}, red);
    add_triangle(scene, {-3, 0.5, -1}, {3, 0, 1}, {0, 2.75, 0.25}, blue);
    add_triangle(scene, {-2, 1, 2}, {2, 1, 2}, {0, 1, -3}, mirror);
    add_sphere(scene, {0, 1, 0}, 0.875, blue);
    add_sphere(scene, {0.5, 1, 0.25}, 0.875, mirror);
    add_floor(scene, {0, 0, 0}, 12, red);
    return scene;
}

/// A fan of triangles as thin as 1 over `aspect`, a wall of another color behind.
Scene needle_fan(double aspect) {
    Scene scene = bare_scene();
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const int blue = add_matt(scene, {0.125, 0.25, 0.875});
    const int count = 40;
    const double width = 5 / aspect, y = 0.5;
    for (int i = 0; i < count; ++i) {
        const double x = -2.5 + width * i;
        add_triangle(scene, {x, y, 1}, {x + width, y, 1}, {0.5, y + 2, -1}, red);
    }
    add_triangle(scene, {-2.5 + width * count, y, 1}, {2.5, y, 1}, {0.5, y + 2, -1}, red);
    add_quad(scene, {-4, -1, -2}, {4, -1, -2}, {4, 4, -2}, {-4, 4, -2}, blue);
    return scene;
}

/// A prism with 12 sides, one end near the eye and the other far away in a slanted direction.
Scene long_prism(double length) {
    Scene scene = bare_scene();
    add_floor(scene, {0, -2, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const glm::dvec3 along = length * glm::normalize(glm::dvec3(0.5, 0.25, -0.75));
    const auto rim = [](int i) {
        const double angle = i * std::numbers::pi / 6;
        return glm::dvec3(std::cos(angle), std::sin(angle), 0);
    };
    for (int i = 0; i < 12; ++i) {
        add_quad(scene, rim(i) + along, rim(i), rim(i + 1), rim(i + 1) + along, red);
    }
    set_view(scene, {-1, 2, 6}, {0.5, 0, 0}, 50);
    return scene;
}

/// Sees the square from -1 to 1 so that samples fall on its diagonal.
Scene square_view() {
    Scene scene = bare_scene(48, 48);
    scene.background = {0.25, 0.5, 0.75};
    set_orthographic(scene, {0, 0, 5}, {0, 0, 0}, 2.5);
    return scene;
}

/// Two triangles of glass that share the diagonal.
Scene pane() {
    Scene scene = square_view();
    add_quad(scene, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, add_glass(scene, 1.5, 0.5));
    return scene;
}

/// The back of a one-sided sheet whose front, away from the eye, is lit.
Scene sheet_from_behind() {
    Scene scene = square_view();
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    add_quad(scene, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}, red);
    scene.lights = {{{1, 2, -5}, glm::dvec3(0.75)}};
    return scene;
}

/// Two blocks of glass, one behind the other, this far apart.
Scene blocks(double apart, double other_ior) {
    Scene scene = square_view();
    const int front = add_glass(scene, 1.5, 0.875, 0.0625, 0.03125);
    const int rear = add_glass(scene, other_ior, 0.75, 0, 0.0625);
    set_view(scene, {0.5, 0.75, 5}, {0, 0, 0}, 30);
    add_box(scene, {-1, -1, 0}, {1, 1, 0.5}, front);
    add_box(scene, {-1, -1, -0.5}, {1, 1, -apart}, rear);
    return scene;
}

/// A box of glass this high above a checkered floor, which comes after it in the scene.
Scene box_on_floor(double height) {
    Scene scene = bare_scene();
    add_box(scene, {-1, height, -1}, {1, height + 1, 1}, add_glass(scene, 1.5));
    const int red = add_matt(scene, {0.875, 0.25, 0.125}), gray = add_matt(scene, glm::dvec3(0.5));
    for (int i = 0; i < 64; ++i) {
        const double x = i % 8 - 4, z = i / 8 - 4;
        add_floor(scene, {x + 0.5, 0, z + 0.5}, 0.5, (i + i / 8) % 2 == 0 ? red : gray);
    }
    set_view(scene, {1, 3, 5}, {0, 0.25, 0}, 40);
    return scene;
}

}  // namespace

StressFamilies triangle_families() {
    const auto square = [](Copy copy) {
        return seen_as(single_square(), picture_case(duplicate_square(copy)));
    };
    const auto ball = [](double moved, ReferenceKind reference) {
        return picture_case(duplicate_ball(moved), {}, reference);
    };
    const auto near = [](auto scene) { return seen_as(scene(1e-9), picture_case(scene(0))); };
    const auto same = [](double apart) { return blocks(apart, 1.5); };
    const auto other = [](double apart) { return blocks(apart, 1.25); };
    return {
        listed({"ties", "what is duplicated",
                "where surfaces coincide, rounding or the order of tests picks the color"},
               {{"same", square(Copy::same)},
                {"other-diagonal", quick(square(Copy::other_diagonal))},
                {"turned", square(Copy::turned)},
                {"reversed", square(Copy::reversed_order)},
                {"overlapping", quick(seen_as(overlapping_squares(true),
                                              picture_case(overlapping_squares(false))))},
                {"tube", quick(seen_as(single_tube(), picture_case(duplicate_tube())))},
                {"ball", ball(0, ReferenceKind::quad)},
                {"two-sheets", quick(picture_case(two_sheets()))},
                {"ball-moved-1e-7", quick(ball(1e-7, ReferenceKind::none))}}),
        sweep({"coincident", "primitives",
               "a million primitives in one place: ties everywhere, a hierarchy without a split"},
              {1000, 1'000'000}, {1000},
              [](int count) {
                  StressCase one = seen_as(pile(2), picture_case(Scene()));
                  std::get<PictureTrial>(one.trial).scene = [=] { return pile(count); };
                  return one;
              }),
        // Glass that touches glass or something else looks as if it were a hair away.
        listed({"touching", "what touches",
                "refracted rays are caught between surfaces that share an edge or a place"},
               {{"halves-of-a-pane", quick(picture_case(pane()))},
                {"halves-lit-from-behind", quick(picture_case(sheet_from_behind()))},
                {"blocks", quick(near(same))},
                {"blocks-of-two-kinds", near(other)},
                {"box-on-a-floor", quick(near(box_on_floor))}}),
        listed({"crossing", "scene",
                "faces through faces and balls: points within rounding of a neighbor"},
               {{"crossing", quick(picture_case(crossing_scene()))}}),
        sweep({"needles", "length over width",
               "distances to thin triangles are inaccurate, and gaps open next to them"},
              {1e2, 1e3, 1e4, 1e6, 1e8}, {1e4, 1e6}, needle_fan),
        // A floor triangle so large that its barycentric weights barely determine a point.
        sweep({"huge-triangle", "half side of the floor",
               "weights of far-away vertices lift points off the floor"},
              {1e2, 1e4, 1e6, 1e8, 1e13, 1e17}, {1e6, 1e17},
              [](double side) {
                  Scene scene = still_life();
                  scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + 2);
                  add_floor(scene, {0, 0, 0}, side, 2);
                  return scene;
              }),
        sweep({"long-triangle", "length of a prism",
               "rounding tilts the planes of long, thin triangles, along all their length"},
              {1e2, 1e4, 1e6, 1e8, 1e10}, {1e8}, long_prism),
        // A triangle whose size is half its distance.
        sweep({"far-triangle", "distance of a triangle",
               "products of three coordinates leave the range of float"},
              {1e6, 1e12, 1e14, 1e17}, {1e14}, [](double distance) {
                  Scene scene = still_life();
                  const double size = 0.25 * distance;
                  add_triangle(scene, {-size, -size, -distance}, {size, -size, -distance},
                               {0, size, -distance}, 0);
                  return scene;
              })};
}

}  // namespace rt
