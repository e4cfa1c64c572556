// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/stress/reference.h"
#include "host/stress/stress_scenes.h"
#include "host/stress/wide_shapes.h"
#include "tests/test_random.h"

// The stress suite's reference against closed forms.
namespace rt::this_file {
namespace {

constexpr ReferenceKind both_kinds[] = {ReferenceKind::quad, ReferenceKind::extended};

/// A ball at the origin, the eye 4 in front of it, one light.
Scene one_ball(glm::dvec3 light) {
    Scene scene = bare_scene();
    set_image_size(scene, 9, 9);
    set_view(scene, {0, 0, 4}, {0, 0, 0}, 30);
    scene.lights = {{light, {0.5, 0.25, 1}}};
    add_sphere(scene, {0, 0, 0}, 1, add_matt(scene, {0.5, 0.75, 0.25}, 0.5, 30));
    return scene;
}

glm::dvec3 center_color(const Scene& scene, ReferenceKind kind) {
    return make_reference_tracer(scene, kind)(scene.width / 2.0, scene.height / 2.0, 0, 0);
}

void expect_color(const glm::dvec3& color, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], 1e-15) << c;
}

/// The normal is (0, 0, 1); the light lies at (0, 3, 4) from the hit, the eye above it.
TEST(ReferenceTracer, ShadesTheMiddleOfABall) {
    const Scene scene = one_ball({0, 3, 5});
    const double cosine = 4 / 5.0;
    const glm::dvec3 l(0, 3 / 5.0, 4 / 5.0);
    const double half = (l.z + 1) / std::sqrt(l.y * l.y + (l.z + 1) * (l.z + 1));
    const double lobe = std::pow(half, 30);
    const glm::dvec3 expected =
        glm::dvec3(0.5, 0.75, 0.25) * 0.25 +
        glm::dvec3(0.5, 0.25, 1) * (cosine * glm::dvec3(0.5, 0.75, 0.25) + lobe * glm::dvec3(0.5));
    for (const ReferenceKind kind : both_kinds) {
        expect_color(center_color(scene, kind), expected);
    }
}

TEST(ReferenceTracer, AShadowLeavesAmbientLight) {
    Scene scene = one_ball({0, 3, 5});
    add_sphere(scene, {0, 1.5, 3}, 0.25, 0);
    for (const ReferenceKind kind : both_kinds) {
        expect_color(center_color(scene, kind), glm::dvec3(0.125, 0.1875, 0.0625));
    }
}

TEST(ReferenceTracer, ALightBehindTheObstacleIsNotSeenButOneBeforeItIs) {
    Scene scene = one_ball({0, 3, 5});
    add_sphere(scene, {0, 6, 9}, 0.25, 0);  // on the same line, beyond the light
    const auto lit = center_color(scene, ReferenceKind::quad);
    EXPECT_GT(lit[0], 0.3);
}

/// A mirror at z = 0 shows the background, or a ball behind the eye at twice the distance.
TEST(ReferenceTracer, APlaneMirrorsWhatIsBehindTheEye) {
    Scene scene = bare_scene();
    set_image_size(scene, 9, 9);
    set_view(scene, {0, 0, 4}, {0, 0, 0}, 30);
    scene.lights.clear();
    const int mirror = add_mirror(scene, 0.5, 0);
    add_quad(scene, {-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}, mirror);
    for (const ReferenceKind kind : both_kinds) {
        expect_color(center_color(scene, kind), 0.5 * scene.background);
    }
    add_sphere(scene, {0, 0, 8}, 1, add_matt(scene, {0.5, 0.75, 0.25}));
    for (const ReferenceKind kind : both_kinds) {
        expect_color(center_color(scene, kind), 0.125 * glm::dvec3(0.5, 0.75, 0.25));
    }
}

/// Between two facing mirrors, n bounces multiply by the n-th power of the reflectance.
TEST(ReferenceTracer, FacingMirrorsCountTheirBounces) {
    Scene scene = bare_scene();
    set_view(scene, {0, 0, 1}, {0, 0, 0}, 30);
    set_image_size(scene, 9, 9);
    scene.ambient_light = glm::dvec3(1);
    scene.lights.clear();
    scene.max_bounces = 3;
    const int mirror = add_mirror(scene, 0.5, 0.25);
    add_quad(scene, {-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}, mirror);
    add_quad(scene, {8, -8, 2}, {-8, -8, 2}, {-8, 8, 2}, {8, 8, 2}, mirror);
    expect_color(center_color(scene, ReferenceKind::quad),
                 glm::dvec3(0.25 * (1 + 0.5 + 0.25 + 0.125)));
}

TEST(ReferenceTracer, FirstListedOfTwoInOnePlaceIsSeen) {
    Scene scene = one_ball({0, 3, 5});
    scene.lights.clear();
    add_sphere(scene, {0, 0, 0}, 1, add_matt(scene, glm::dvec3(1)));
    expect_color(center_color(scene, ReferenceKind::quad), glm::dvec3(0.125, 0.1875, 0.0625));
}

TEST(ReferenceTracer, BothKindsAgree) {
    Scene scene = still_life();
    set_image_size(scene, 20, 15);
    const auto quad = make_reference_tracer(scene, ReferenceKind::quad);
    const auto extended = make_reference_tracer(scene, ReferenceKind::extended);
    for (int y = 0; y < 15; ++y) {
        for (int x = 0; x < 20; ++x) {
            const auto a = quad(x + 0.5, y + 0.5, 0, 0);
            const auto b = extended(x + 0.5, y + 0.5, 0, 0);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-12);
        }
    }
}

// Cones

/// A cylinder about the y axis, seen from the side: its normal there is a ball's.
TEST(ReferenceTracer, ShadesACylinderLikeABall) {
    const Scene ball = one_ball({0, 3, 5});
    Scene cylinder = ball;
    cylinder.spheres.clear();
    add_cone(cylinder, {0, -1, 0}, 1, {0, 1, 0}, 1, 0);
    for (const ReferenceKind kind : both_kinds) {
        const auto expected = center_color(ball, kind);
        expect_color(center_color(cylinder, kind), {expected[0], expected[1], expected[2]});
    }
}

/// The normal of a cone as wide as high is tilted up by 45 degrees: a light straight along it gives
/// the full diffuse color.
TEST(ReferenceTracer, ShadesASlantedSide) {
    Scene scene = one_ball({0, 3, 3.5});
    scene.spheres.clear();
    scene.materials[0].specular = glm::dvec3(0);
    add_cone(scene, {0, -0.5, 0}, 1, {0, 0.5, 0}, 0, 0);
    const glm::dvec3 color(0.5, 0.75, 0.25);
    expect_color(center_color(scene, ReferenceKind::quad),
                 0.25 * color + glm::dvec3(0.5, 0.25, 1) * color);
}

/// A frustum is open: rays along its axis pass through, as do rays beyond its rims, and its inside
/// is seen past the near side's rim.
TEST(ReferenceTracer, AFrustumIsOpen) {
    Scene scene = one_ball({0, 3, 5});
    scene.lights.clear();
    scene.spheres.clear();
    add_cone(scene, {0, 0, -1}, 0.5, {0, 0, 1}, 1, 0);
    expect_color(center_color(scene, ReferenceKind::quad), scene.background);
    scene.cones.clear();
    add_cone(scene, {0, 0.01, 0}, 1, {0, 1, 0}, 1, 0);
    expect_color(center_color(scene, ReferenceKind::quad), scene.background);
    set_view(scene, {0, 2, 4}, {0, 0.5, -1}, 30);
    expect_color(center_color(scene, ReferenceKind::quad), glm::dvec3(0.125, 0.1875, 0.0625));
}

/// The other half of the double cone, beyond the tip, does not count.
TEST(ReferenceTracer, AConeHasOneHalf) {
    Scene scene = one_ball({0, 3, 5});
    scene.lights.clear();
    scene.spheres.clear();
    add_cone(scene, {0, -2, 0}, 2, {0, -0.01, 0}, 0, 0);
    expect_color(center_color(scene, ReferenceKind::quad), scene.background);
}

// Glass

/// Looks along -z, `height` above the axis, at a ball of this index about the origin.
Scene glass_ball(double height, double ior, double mirror = 0) {
    Scene scene = bare_scene();
    set_image_size(scene, 9, 9);
    set_orthographic(scene, {0, height, 4}, {0, height, 0}, 1);
    scene.lights.clear();
    scene.ambient_light = glm::dvec3(1);
    add_sphere(scene, {0, 0, 0}, 1, add_glass(scene, ior, 0.5, mirror));
    return scene;
}

/// Each of the two refractions halves the light.
TEST(ReferenceTracer, GlassShowsTheBackgroundBehind) {
    for (const ReferenceKind kind : both_kinds) {
        const Scene scene = glass_ball(0.3, 1.5);
        expect_color(center_color(scene, kind), 0.25 * scene.background);
    }
}

/// A ray at height b is deflected by 2 (asin b - asin(b / n)) and leaves at the angle asin b to the
/// normal of its exit point. A wall whose edge lies there verifies this to 1e-12.
TEST(ReferenceTracer, ABallRefractsAsSnellSays) {
    for (const double ior : {1.5, 2.4, 0.9}) {
        const double b = 0.6, in = std::asin(b), through = std::asin(b / ior);
        const double turn = 2 * (in - through);
        const double y = std::sin(2 * through - in), z = -std::cos(2 * through - in);
        const double wall = -3, meets = y - std::tan(turn) * (z - wall);
        for (const double off : {-1e-12, 1e-12}) {
            Scene scene = glass_ball(b, ior);
            const int red = add_matt(scene, {1, 0, 0});
            add_quad(scene, {-9, meets + off, wall}, {9, meets + off, wall}, {9, 9, wall},
                     {-9, 9, wall}, red);
            const glm::dvec3 seen = off < 0 ? glm::dvec3(1, 0, 0) : scene.background;
            expect_color(center_color(scene, ReferenceKind::quad), 0.25 * seen);
        }
    }
}

/// A right-angled prism turns the view up by total internal reflection where sin 45 exceeds 1 / n:
/// weight mirror + glass, and two refractions. Else most of it leaves through the slope.
TEST(ReferenceTracer, APrismReflectsAll) {
    for (const double ior : {1.5, 1.4}) {
        Scene scene = bare_scene();
        set_image_size(scene, 9, 9);
        set_view(scene, {0, 0, 4}, {0, 0, 0}, 5);
        scene.lights.clear();
        scene.ambient_light = glm::dvec3(1);
        const int glass = add_glass(scene, ior, 0.5, 0.125);
        add_quad(scene, {-2, -1, 1}, {2, -1, 1}, {2, 1, 1}, {-2, 1, 1}, glass);    // front
        add_quad(scene, {-2, 1, 1}, {2, 1, 1}, {2, 1, -1}, {-2, 1, -1}, glass);    // top
        add_quad(scene, {-2, -1, 1}, {-2, 1, -1}, {2, 1, -1}, {2, -1, 1}, glass);  // slope
        scene.max_bounces = 3;
        add_floor(scene, {0, 3, 0}, 1, add_matt(scene, {1, 0, 0}));
        const bool total = ior > std::numbers::sqrt2;
        const glm::dvec3 red(0.5 * (total ? 0.625 : 0.125) * 0.5, 0, 0);
        const double background = total ? 0.125 : 0.125 + 0.25;
        expect_color(center_color(scene, ReferenceKind::quad), background * scene.background + red);
    }
}

/// With index 1 nothing bends.
TEST(ReferenceTracer, IndexOneIsTheBackground) {
    for (const ReferenceKind kind : both_kinds) {
        Scene scene = glass_ball(0.7, 1);
        scene.materials[0].transmission = glm::dvec3(1);
        expect_color(center_color(scene, kind), scene.background);
    }
}

// Balls around shapes

/// Rays to points of the surface, rims and corners included, from near and from far.
template <typename Shape, typename PointOf>
void expect_rays_are_not_left_out(const Shape& shape, const PointOf& point_of) {
    using stress::Quad;
    Random random(7);
    const stress::Bound<Quad> bound = stress::bound_of(shape);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const stress::Wide3<Quad> target = point_of(random);
        stress::WideRay<Quad> ray;
        ray.dir = stress::unit(stress::Wide3<Quad>(random.unit_vector()));
        ray.origin = target - Quad(random.log_uniform(1e-6, 1e12)) * ray.dir;
        if (!(stress::hit_shape(ray, shape, false).t > 0)) continue;
        ++hits;
        ASSERT_FALSE(stress::passes_by(ray.origin, stress::Wide3<long double>(ray.dir), bound));
    }
    EXPECT_GT(hits, 5000);
}

TEST(Bound, IsPassedByNoRayThatHitsWhatIsInIt) {
    using stress::Quad;
    const Scene::Sphere sphere{{3e6, -2, 1}, 1e-11, 0};
    const auto ball = stress::wide_sphere<Quad>(sphere);
    expect_rays_are_not_left_out(ball, [&](Random& random) {
        const Quad radius = ball.radius * (1 - Quad(random.log_uniform(1e-25, 1e-3)));
        return ball.center + radius * stress::unit(stress::Wide3<Quad>(random.unit_vector()));
    });

    Scene::Cone cone;
    cone.base = {1, 2, 3};
    cone.apex = {-2, 5, 1};
    cone.base_radius = 0.2;
    cone.apex_radius = 1.5;
    const auto frustum = stress::wide_cone<Quad>(cone);
    expect_rays_are_not_left_out(frustum, [&](Random& random) {
        const auto end = random.log_uniform(1e-25, 1);
        const Quad height = frustum.length * (random.coin() ? Quad(end) : 1 - Quad(end));
        const auto around = stress::Wide3<Quad>(random.unit_vector());
        const auto across = stress::unit(stress::cross(frustum.axis, around));
        return frustum.base + height * frustum.axis +
               (frustum.radius + frustum.slope * height) * across;
    });

    Scene::Triangle triangle;
    triangle.vertices = {{{0, 0, 5}, {4, 1, 5}, {0.5, 1e-3, 6}}};
    const auto face = stress::wide_triangle<Quad>(triangle);
    expect_rays_are_not_left_out(face, [&](Random& random) {
        const Quad u = random.log_uniform(1e-25, 1), v = (1 - u) * Quad(random.uniform(0, 1));
        return face.corner + (1 - u - v) * face.edge1 + v * face.edge2;
    });
}

}  // namespace
}  // namespace rt::this_file
