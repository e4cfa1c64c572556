// SPDX-License-Identifier: Apache-2.0
//
// Pictures of surfaces that touch, against closed forms, with samples that fall exactly on edges:
// triangles that share an edge act as one sheet, and a refracted ray crosses surfaces that lie in
// one place in the scene's order, each once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/render/threads_renderer.h"
#include "tests/hit_scenes.h"
#include "tests/test_random.h"
#include "tests/whole_film.h"

namespace rt::this_file {
namespace {

constexpr int size = 16;

/// The middle of a pixel in the view of front_view.
glm::dvec3 place_of(int x, int y) {
    return {2.0 * (x + 0.5) / size - 1, 1 - 2.0 * (y + 0.5) / size, 0};
}

/// Looks along -z at the square from -1 to 1.
Scene front_view() {
    Scene scene;
    scene.camera.projection = Scene::Projection::orthographic;
    scene.camera.from = {0, 0, 5};
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::view_height, 2};
    scene.aa = grid_aa(1);
    set_image_size(scene, size, size);
    return scene;
}

/// Two triangles, counterclockwise, that share the diagonal from a to c.
void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, int material) {
    const auto& [a, b, c, d] = corners;
    scene.triangles.push_back({{a, b, c}, {}, material});
    scene.triangles.push_back({{a, c, d}, {}, material});
}

/// The faces of a box across the z axis that an orthographic ray along it meets.
void add_slab(Scene& scene, double half, double back, double front, int material) {
    const double h = half;
    add_quad(scene, {{{-h, -h, front}, {h, -h, front}, {h, h, front}, {-h, h, front}}}, material);
    add_quad(scene, {{{-h, -h, back}, {-h, h, back}, {h, h, back}, {h, -h, back}}}, material);
}

Scene::Material glass(double transmission, double ior) {
    Scene::Material material;
    material.transmission = glm::dvec3(transmission);
    material.ior = ior;
    return material;
}

Scene::Material matte(double ambient, double diffuse) {
    Scene::Material material;
    material.ambient = glm::dvec3(ambient);
    material.diffuse = glm::dvec3(diffuse);
    return material;
}

template <typename T>
Film<T> picture(const Scene& scene, int lanes, const FlattenOptions& flattening = {}) {
    const FlatScene<T> flat = flatten<T>(scene, flattening);
    ThreadsOptions options;
    options.kernels.lanes = lanes;
    return whole_film(*make_threads_renderer(flat, options), scene.width, scene.height);
}

/// Expects the red of each pixel that shows the square of half the size `half` around the origin,
/// one ray at a time and in packets.
template <typename T>
void expect_square(const Scene& scene, double half,
                   const std::function<double(const glm::dvec3&)>& red) {
    for (const int lanes : {1, 0}) {
        const Film<T> film = picture<T>(scene, lanes);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 place = place_of(x, y);
                if (std::abs(place.x) > half || std::abs(place.y) > half) continue;
                ASSERT_NEAR(double(film.rgb[std::size_t(3 * (y * size + x))]), red(place), 1e-5)
                    << x << "," << y << ", lanes " << lanes;
            }
        }
    }
}

template <typename T>
class Touching : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Touching, Precisions);

TYPED_TEST(Touching, APaneOfTwoTrianglesIsOne) {
    Scene scene = front_view();
    scene.background = glm::dvec3(1);
    scene.materials = {glass(0.5, 1)};
    add_quad(scene, {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, 0);
    expect_square<TypeParam>(scene, 1, [](const auto&) { return 0.5; });
    scene.materials = {glass(0.9, 1.5)};
    expect_square<TypeParam>(scene, 1, [](const auto&) { return 0.9; });
}

/// Two mirrors at a right angle, seen along one of them: whatever the first bounce starts from,
/// next to their common edge too, it meets the other one.
TYPED_TEST(Touching, MirrorsThatMeetLeaveNoGap) {
    Scene scene;
    scene.camera.from = {-0.5, 0.99, 0.1};
    scene.camera.at = {1, 1, 0.1};
    scene.camera.up = {-0.01, 1.5, 0};
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::horizontal, 60};
    scene.aa = grid_aa(1);
    set_image_size(scene, 500, 1);
    scene.background = glm::dvec3(1);
    scene.max_bounces = 1;
    scene.materials.emplace_back().mirror = glm::dvec3(1);
    add_quad(scene, {{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}}, 0);
    scene.triangles.push_back({{{{-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}}, {}, 0});
    scene.triangles.push_back({{{{-1, 1, -1}, {1, 1, 1}, {1, 1, -1}}}, {}, 0});
    for (const int lanes : {1, 0}) {
        const Film<TypeParam> film = picture<TypeParam>(scene, lanes);
        EXPECT_EQ(std::count(film.rgb.begin(), film.rgb.end(), TypeParam(0)), 1500);
    }
}

TYPED_TEST(Touching, TheFarSideOfAOneSidedSheetIsLitOnItsEdgesToo) {
    Scene scene = front_view();
    scene.materials = {matte(0, 1)};
    scene.lights.push_back({{1, 2, -5}, glm::dvec3(1), true});
    add_quad(scene, {{{1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}}}, 0);
    expect_square<TypeParam>(scene, 0.9, [](const glm::dvec3& place) {
        const glm::dvec3 to_light = glm::normalize(glm::dvec3(1, 2, -5) - place);
        return -to_light.z;
    });
}

TYPED_TEST(Touching, BlocksOfGlassAreCrossedOneAfterTheOther) {
    for (const double other_ior : {1.5, 1.33}) {
        Scene scene = front_view();
        scene.background = glm::dvec3(1);
        scene.materials = {glass(0.9, 1.5), glass(0.8, other_ior)};
        add_slab(scene, 1, 0, 0.5, 0);
        add_slab(scene, 1, -0.5, 0, 1);
        expect_square<TypeParam>(scene, 0.9, [](const auto&) { return 0.9 * 0.9 * 0.8 * 0.8; });
    }
}

TYPED_TEST(Touching, BodiesOfGlassInOnePlaceAreEnteredAndLeft) {
    Scene balls = front_view();
    balls.background = glm::dvec3(1);
    balls.materials = {glass(0.9, 1.5), glass(0.8, 1.33)};
    Scene tubes = balls;
    for (const int material : {0, 1}) {
        balls.spheres.push_back({glm::dvec3(0), 1, material});
        tubes.cones.push_back({{0, -1, 0}, {0, 1, 0}, 0.7, 0.8, material});
    }
    for (const Scene& scene : {balls, tubes}) {
        expect_square<TypeParam>(scene, 0.6, [](const auto&) { return 0.9 * 0.9 * 0.8 * 0.8; });
    }
}

TYPED_TEST(Touching, SheetsInOnePlaceAreCrossedByGrazingRays) {
    for (const double height : {1.0, 0.1, 0.01}) {
        Scene scene = front_view();
        scene.camera.from = {0, -4 - height, -4 + height};
        scene.camera.field_of_view.amount = 0.1 * height;
        scene.background = glm::dvec3(1);
        scene.materials = {glass(0.9, 1), glass(0.8, 1)};
        for (const int material : {0, 1}) {
            add_quad(scene, {{{-9, -9, -9}, {9, -9, -9}, {9, 9, 9}, {-9, 9, 9}}}, material);
        }
        expect_square<TypeParam>(scene, 1, [](const auto&) { return 0.9 * 0.8; });
    }
}

TYPED_TEST(Touching, SheetsOnALevelFloorAreCrossedBelowLowEyes) {
    for (const double height : {1.0, 0.2, 0.05}) {
        Scene scene = front_view();
        scene.camera.projection = Scene::Projection::perspective;
        scene.camera.from = {0.3, height, 10};
        scene.camera.field_of_view.amount = 0.05 * height;
        scene.ambient_light = scene.background = glm::dvec3(1);
        scene.materials = {glass(0.9, 1), matte(0.5, 0)};
        for (const int material : {0, 1}) {
            const double half = material == 0 ? 4 : 40;
            add_quad(scene,
                     {{{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}}},
                     material);
        }
        expect_square<TypeParam>(scene, 1, [](const auto&) { return 0.9 * 0.5; });
    }
}

TYPED_TEST(Touching, GlassStandsOnAFloor) {
    for (const bool is_floor_first : {false, true}) {
        Scene scene = front_view();
        scene.ambient_light = glm::dvec3(1);
        scene.materials = {glass(0.9, 1.5), matte(0.5, 0)};
        const auto add_floor = [&] {
            add_quad(scene, {{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, 1);
        };
        if (is_floor_first) add_floor();
        add_slab(scene, 1, 0, 0.5, 0);
        if (!is_floor_first) add_floor();
        const double exits = is_floor_first ? 1 : 0.9;  // the first of two in one place is met
        expect_square<TypeParam>(scene, 0.9, [&](const auto&) { return 0.9 * exits * 0.5; });
    }
}

TYPED_TEST(Touching, AFloorIsSeenThroughAThinPaneOnIt) {
    for (const double thickness : {0.1, 0.01, 0.001}) {
        for (const double gap : {0.0, 1e-16, 4e-16, 1e-15, 4e-15, 1e-8, 1e-7, 4e-7, 1e-6, 1e-5}) {
            Scene scene = front_view();
            scene.ambient_light = glm::dvec3(1);
            scene.materials = {glass(0.9, 1.5), matte(0.5, 0)};
            add_slab(scene, 1, 0.7, 0.7 + thickness, 0);
            const double z = 0.7 - gap;
            add_quad(scene, {{{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}}}, 1);
            expect_square<TypeParam>(scene, 0.9, [](const auto&) { return 0.9 * 0.9 * 0.5; });
        }
    }
}

TYPED_TEST(Touching, ATiltedTableIsSeenThroughAPaneOnItAtAnyAngle) {
    Random random(5);
    for (int i = 0; i < 24; ++i) {
        const glm::dvec3 up = random.unit_vector();
        const glm::dvec3 right = glm::normalize(glm::cross(up, random.unit_vector()));
        const glm::dvec3 ahead = glm::cross(up, right);
        const auto level = [&](double half, double height) -> std::array<glm::dvec3, 4> {
            const glm::dvec3 a = half * (right + ahead), b = half * (right - ahead);
            return {height * up + a, height * up + b, height * up - a, height * up - b};
        };
        Scene scene = front_view();
        scene.ambient_light = glm::dvec3(1);
        scene.materials = {glass(1, 1), matte(0.5, 0)};
        scene.materials[1].two_sided = true;
        auto above = level(2, 0.1);
        std::ranges::reverse(above);
        add_quad(scene, above, 0);
        add_quad(scene, level(2, 0), 0);
        add_quad(scene, level(5, 0), 1);
        scene.camera.projection = Scene::Projection::perspective;
        scene.camera.from = (i % 2 == 0 ? 0.2 : 0.12) * up;
        scene.camera.at = (i % 3 + 0.2) * 0.4 * ahead;
        scene.camera.up = up;
        scene.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, 4};
        set_image_size(scene, size, size);
        expect_square<TypeParam>(scene, 1, [](const auto&) { return 0.5; });
    }
}

TYPED_TEST(Touching, ALightNearAHugeBallDoesNotShineThroughIt) {
    Scene scene = front_view();
    scene.materials = {matte(0, 1)};
    scene.lights.push_back({{4, 0, 3}, glm::dvec3(1), true});
    scene.spheres.push_back({{2 - 1e6, 0, 0}, 1e6, 0});
    add_quad(scene, {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, 0);
    expect_square<TypeParam>(scene, 1, [](const auto&) { return 0; });
    scene.triangles.clear();  // nor onto its far side
    scene.materials[0].two_sided = true;
    scene.camera.projection = Scene::Projection::perspective;
    scene.spheres[0].center = {0, 0, 7 - 1e6};
    for (const double height : {0.01, 1.0, 4.0}) {
        scene.lights[0].position = {0, 0, 7 + height};
        expect_square<TypeParam>(scene, 1, [](const auto&) { return 0; });
    }
}

TYPED_TEST(Touching, ARingWithoutHeightIsARing) {
    for (const double height : {1e-2, 1e-4, 1e-6, 1e-8, 1e-12, 1e-30}) {
        for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
            Scene scene = front_view();
            scene.ambient_light = glm::dvec3(1);
            scene.materials = {matte(0.5, 0)};
            scene.cones.push_back({glm::dvec3(0), height * axis, 0.8, 0.3, 0});
            expect_square<TypeParam>(scene, 1, [](const glm::dvec3& place) {
                const double radius = glm::length(place);
                return radius > 0.3 && radius < 0.8 ? 0.5 : 0;
            });
        }
    }
}

TYPED_TEST(Touching, HeadOnRaysPassGlassOfAnyIndex) {
    for (const double ior : {5e-324, 1e-300, 1e-45, 1e-39, 1e-20, 1.0, 1e20, 1e30}) {
        Scene scene = front_view();
        scene.background = glm::dvec3(1);
        scene.materials = {glass(0.9, ior)};
        add_slab(scene, 1, -0.5, 0.5, 0);
        expect_square<TypeParam>(scene, 0.9, [](const auto&) { return 0.9 * 0.9; });
    }
}

/// Seen from behind a sheet, a light in front of it makes no highlight, unless the exponent is 0.
TYPED_TEST(Touching, TheSmallestExponentIsNotZero) {
    for (const double exponent : {5e-324, 1e-300, 1e-45, 1e-20, 0.0}) {
        Scene scene = front_view();
        scene.materials = {matte(0, 0)};
        scene.materials[0].specular = glm::dvec3(0.5);
        scene.materials[0].shininess = exponent;
        scene.lights.push_back({{3, 0, -1}, glm::dvec3(1), true});
        add_quad(scene, {{{1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}}}, 0);
        expect_square<TypeParam>(scene, 1, [=](const auto&) { return exponent == 0 ? 0.5 : 0; });
    }
}

/// Mirrors so far away that they are one surface for most rays, which meet many from inside.
TYPED_TEST(Touching, ShapesSmallerThanRoundingLookTheSameWithAndWithoutHierarchies) {
    using T = TypeParam;
    Random random(5);
    Scene scene = front_view();
    scene.camera.projection = Scene::Projection::perspective;
    const double distance = 1 / double(Flat<T>::roundoff);
    scene.camera.from = {0, 0, distance};
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::vertical,
                                  300 / (std::numbers::pi * distance)};
    set_image_size(scene, 64, 64);
    scene.background = {0.25, 0.5, 0.75};
    scene.ambient_light = glm::dvec3(0.25);
    Scene::Material mirror = matte(1, 0);
    mirror.mirror = glm::dvec3(0.75);
    scene.materials = {mirror};
    Scene tubes = scene;
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 place = random.in_cube(1);
        scene.spheres.push_back({place, random.uniform(0.05, 0.25), 0});
        tubes.cones.push_back({place, place + 0.2 * random.unit_vector(), 0.2, 0.1, 0});
    }
    FlattenOptions with, without;
    with.hierarchies = true;
    without.hierarchies = false;
    for (const Scene& one : {scene, tubes}) {
        EXPECT_EQ(hash_of(picture<T>(one, 0, with)), hash_of(picture<T>(one, 0, without)));
    }
}

}  // namespace
}  // namespace rt::this_file
