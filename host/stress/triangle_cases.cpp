// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/stress/case_helpers.h"
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

StressFamily ties() {
    StressFamily family{"ties",
                        "what lies twice",
                        "where two surfaces are one, rounding or the "
                        "order of tests picks a color",
                        {}};
    const auto add = [&](const char* label, InQuick quick, std::function<Scene()> scene,
                         std::function<Scene()> seen) {
        StressCase one =
            picture_case(label, static_cast<double>(family.cases.size()), quick, std::move(scene));
        std::get<PictureTrial>(one.trial).reference_scene = std::move(seen);
        family.cases.push_back(std::move(one));
    };
    add(
        "same", InQuick::no, [] { return duplicate_square(Copy::same); }, single_square);
    add(
        "other-diagonal", InQuick::yes, [] { return duplicate_square(Copy::other_diagonal); },
        single_square);
    add(
        "turned", InQuick::no, [] { return duplicate_square(Copy::turned); }, single_square);
    add(
        "reversed", InQuick::no, [] { return duplicate_square(Copy::reversed_order); },
        single_square);
    add(
        "overlapping", InQuick::yes, [] { return overlapping_squares(false); },
        [] { return overlapping_squares(true); });
    add("tube", InQuick::yes, duplicate_tube, [] {
        Scene scene = duplicate_tube();
        scene.cones.resize(1);
        return scene;
    });
    add("ball", InQuick::no, [] { return duplicate_ball(0); }, {});
    add("two-sheets", InQuick::yes, two_sheets, {});
    StressCase moved = picture_case("ball-moved-1e-7", static_cast<double>(family.cases.size()),
                                    InQuick::yes, [] { return duplicate_ball(1e-7); });
    std::get<PictureTrial>(moved.trial).reference = ReferenceKind::none;
    family.cases.push_back(std::move(moved));
    return family;
}

/// Many copies of one triangle and one ball: one of each is visible, and the others do no harm.
StressFamily coincident() {
    StressFamily family{"coincident",
                        "primitives",
                        "a million primitives in one place: ties "
                        "everywhere, a hierarchy without a split",
                        {}};
    const auto pile = [](std::size_t count) {
        Scene scene = bare_scene();
        set_image_size(scene, 8, 6);
        const int first = add_matt(scene, {0.875, 0.25, 0.125});
        const int rest = add_matt(scene, {0.125, 0.25, 0.875});
        scene.lights.resize(1);
        const std::size_t half = std::max<std::size_t>(1, count / 2);
        for (std::size_t i = 0; i < half; ++i) {
            add_triangle(scene, {-2, 0, 0.5}, {2, 0.25, 0.25}, {0, 2.5, -0.5},
                         i == 0 ? first : rest);
        }
        for (std::size_t i = 0; i < half; ++i) {
            add_sphere(scene, {0, 1, -2}, 1.5, i == 0 ? first : rest);
        }
        return scene;
    };
    for (const std::size_t count : {std::size_t{1000}, std::size_t{1'000'000}}) {
        StressCase one = picture_case(fmt::format("{}", count), static_cast<double>(count),
                                      quick_if(count == 1000), [=] { return pile(count); });
        std::get<PictureTrial>(one.trial).reference_scene = [=] { return pile(2); };
        family.cases.push_back(std::move(one));
    }
    return family;
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

StressFamily needles() {
    StressFamily family{"needles",
                        "length over width",
                        "thin triangles lose their distance, and "
                        "their neighbors",
                        {}};
    for (const double aspect : {1e2, 1e3, 1e4, 1e6, 1e8}) {
        family.cases.push_back(picture_case(fmt::format("{:g}", aspect), aspect,
                                            quick_if(aspect == 1e4 || aspect == 1e6),
                                            [aspect] { return needle_fan(aspect); }));
    }
    return family;
}

/// A floor triangle so large that its barycentric weights barely determine a point.
StressFamily huge_triangles() {
    StressFamily family{"huge-triangle",
                        "half side of the floor",
                        "weights of far-away vertices "
                        "lift points off the floor",
                        {}};
    for (const double side : {1e2, 1e4, 1e6, 1e8}) {
        family.cases.push_back(
            picture_case(fmt::format("{:g}", side), side, quick_if(side == 1e6), [side] {
                Scene scene = still_life();
                scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + 2);
                add_floor(scene, {0, 0, 0}, side, 2);
                return scene;
            }));
    }
    return family;
}

}  // namespace

void add_triangle_families(StressFamilies& families) {
    families.push_back(ties());
    families.push_back(coincident());
    families.push_back({"crossing",
                        "scene",
                        "faces through faces and balls: points within rounding of a neighbor",
                        {picture_case("crossing", 1, InQuick::yes, crossing_scene)}});
    families.push_back(needles());
    families.push_back(huge_triangles());
}

}  // namespace rt
