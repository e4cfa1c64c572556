// SPDX-License-Identifier: Apache-2.0
//
// Refraction in kernels/whitted.cl: Snell's law and the critical angle in closed form, ray trees
// worked out by hand, energy conservation, and the focus of a ball lens.
#include <algorithm>

#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 20000;

template <typename T>
using Counts = typename Flat<T>::RayCounts;

/// Rays that hit surfaces, each with an index of refraction.
template <typename T>
struct Meetings {
    std::vector<ProbeSurface<T>> surfaces;
    std::vector<Packed3<T>> dirs;
    std::vector<T> eta;
    std::vector<Index<T>> prims;

    void add(const glm::dvec3& normal, const glm::dvec3& face, const glm::dvec3& dir, double n) {
        surfaces.push_back({{}, T(0x1p-18), pack<T>(normal), 0, pack<T>(face), 0});
        dirs.push_back(pack<T>(dir));
        eta.push_back(static_cast<T>(n));
        prims.push_back(static_cast<Index<T>>(prims.size()));
    }
    auto device() const {
        return run<T, ProbeRay<T>, Index<T>>("refracted_ray", dirs.size(), surfaces, dirs, eta,
                                             prims);
    }
};

KERNEL_SUITE(RefractedRay);
TYPED_TEST(RefractedRay, ObeysSnell) {
    using T = TypeParam;
    Random random(1);
    Meetings<T> given;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 n = random.unit_vector();
        const double eta = i % 3 == 0 ? 1.5 : (i % 3 == 1 ? 1 / 1.5 : random.uniform(0.3, 3));
        given.add(n, n, random.unit_vector(), eta);
    }
    const auto [rays, total] = given.device();
    WorstError worst;
    std::size_t passing = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 d = exact(given.dirs[i]), n = exact(given.surfaces[i].normal);
        const Quad eta = given.eta[i], cosine = dot(d, n);
        const Quad3 along = eta * (d - cosine * n);
        const Quad squared = 1 - dot(along, along);
        if (magnitude(squared) < 1e-2) continue;
        ASSERT_EQ(total[i] != 0, squared < 0) << i;
        if (squared < 0) continue;
        ++passing;
        const Quad depth = square_root(squared);
        worst.add(vector_error<T>(rays[i].dir, unit(along + (cosine < 0 ? -depth : depth) * n),
                                  1 / depth));
        ASSERT_EQ(rays[i].from, given.prims[i]);
        ASSERT_TRUE(std::isinf(rays[i].t_max));
        ASSERT_TRUE(dot(exact(rays[i].origin), n) * cosine > 0) << i;
    }
    worst.expect_at_most(4);
    EXPECT_GT(passing, count / 2);
}
TYPED_TEST(RefractedRay, IsTotalBeyondTheCriticalAngle) {
    const double critical = std::asin(1 / 1.5);
    Meetings<TypeParam> given;
    for (const double off : {-1e-3, -1e-6, 1e-6, 1e-3}) {
        const double angle = critical + off;
        given.add({0, 0, 1}, {0, 0, 1}, {std::sin(angle), 0, std::cos(angle)}, 1.5);
    }
    const auto total = std::get<1>(given.device());
    EXPECT_EQ(total, (std::vector<Index<TypeParam>>{0, 0, 1, 1}));
}
TYPED_TEST(RefractedRay, GoesStraightOnWhereNothingChanges) {
    using T = TypeParam;
    Random random(2);
    Meetings<T> same, near;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 n = random.unit_vector(), d = random.unit_vector();
        same.add(n, n, d, 1);
        if (std::abs(glm::dot(n, d)) > 0.01) near.add(n, n, d, 1 + (random.coin() ? 1e-7 : -1e-7));
    }
    const auto [rays, total] = same.device();
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_TRUE(same_bits<T>(std::vector{rays[i].dir}, std::vector{same.dirs[i]})) << i;
        ASSERT_EQ(total[i], 0);
    }
    const auto bent = std::get<0>(near.device());
    for (std::size_t i = 0; i < bent.size(); ++i) {
        const Quad3 change = exact(bent[i].dir) - exact(near.dirs[i]);
        ASSERT_LE(double(length(change)), 1e-4) << i;
    }
}
TYPED_TEST(RefractedRay, CrossesTheFaceWhateverTheShadingNormal) {
    Random random(3);
    Meetings<TypeParam> given;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 face = random.unit_vector();
        glm::dvec3 lean = glm::normalize(face + 1.2 * random.unit_vector());
        if (glm::dot(lean, face) < 0) lean = -lean;
        given.add(lean, face, random.unit_vector(), random.uniform(0.4, 2.5));
    }
    const auto [rays, total] = given.device();
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 face = exact(given.surfaces[i].geometric);
        const Quad arriving = dot(exact(given.dirs[i]), face);
        if (total[i] != 0 || magnitude(arriving) < 64 * Quad(Flat<TypeParam>::roundoff)) continue;
        ASSERT_TRUE(dot(exact(rays[i].dir), face) * arriving > 0) << i;
    }
}

/// A scene of one material, without lights or ambient light.
template <typename T>
FlatScene<T> unlit(double mirror, double transmission, double ior, double background) {
    FlatScene<T> scene{};
    typename Flat<T>::Material material{};
    const T m = T(mirror), t = T(transmission), b = T(background);
    material.mirror = {m, m, m};
    material.transmission = {t, t, t};
    material.ior = T(ior);
    scene.materials = {material};
    scene.params.background = {b, b, b};
    scene.params.max_bounces = 8;
    return scene;
}

template <typename T>
auto trace_paths(const FlatScene<T>& scene, const std::vector<ProbeRay<T>>& rays) {
    return run<T, Packed3<T>, Counts<T>>("trace_path", rays.size(), scene, rays);
}

KERNEL_SUITE(TraceTree);
TYPED_TEST(TraceTree, AddsUpAPaneByHand) {
    using T = TypeParam;
    // Two planes of index 1 across the ray: every hit reflects a quarter and transmits half.
    auto scene = unlit<T>(0.25, 0.5, 1, 1);
    scene.triangles = {make_triangle<T>({-9, -9, -1}, {9, -9, -1}, {0, 9, -1}),
                       make_triangle<T>({-9, -9, -2}, {9, -9, -2}, {0, 9, -2})};
    count_primitives(scene);
    const std::vector<ProbeRay<T>> ray{make_ray<T>({0, 0, 0}, {0, 0, -1})};
    struct Case {
        int max_bounces;
        double color;
        std::uint64_t mirror, transmitted;
    };
    // reflected 1/4, then through both 1/4, back out 1/16, inside again and so on
    const Case cases[] = {{0, 0, 0, 0},
                          {1, 0.25, 1, 1},
                          {2, 0.25 + 0.25, 2, 2},
                          {3, 0.25 + 0.25 + 0.0625, 3, 3},
                          {4, 0.25 + 0.25 + 0.0625 + 0.015625, 4, 4}};
    for (const auto& [max_bounces, color, mirror, transmitted] : cases) {
        scene.params.max_bounces = max_bounces;
        const auto [colors, counts] = trace_paths(scene, ray);
        EXPECT_EQ(colors[0].x, T(color)) << max_bounces;
        EXPECT_EQ(counts[0].mirror, mirror) << max_bounces;
        EXPECT_EQ(counts[0].transmitted, transmitted) << max_bounces;
    }
}
TYPED_TEST(TraceTree, ReflectsWithBothWeightsBeyondTheCriticalAngle) {
    using T = TypeParam;
    // From inside index 1.5, where total internal reflection begins at 41.8 degrees.
    auto scene = unlit<T>(0.125, 0.5, 1.5, 1);
    scene.triangles = {make_triangle<T>({-9, -9, -1}, {0, 9, -1}, {9, -9, -1})};
    count_primitives(scene);
    scene.params.max_bounces = 4;
    for (const double degrees : {41.0, 43.0, 60.0, 75.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const std::vector<ProbeRay<T>> ray{
            make_ray<T>({0, 0, 0}, {std::sin(angle), 0, -std::cos(angle)})};
        const auto [colors, counts] = trace_paths(scene, ray);
        EXPECT_EQ(colors[0].x, T(0.625)) << degrees;
        EXPECT_EQ(counts[0].mirror, 1u) << degrees;
        EXPECT_EQ(counts[0].transmitted, degrees < 41.8 ? 1u : 0u) << degrees;
    }
}
TYPED_TEST(TraceTree, SeesTheBackgroundExactlyThroughIndexOne) {
    using T = TypeParam;
    Random random(4);
    auto scene = unlit<T>(0, 1, 1, 0.7);
    for (int i = 0; i < 3; ++i) {
        scene.spheres.push_back(make_sphere<T>(random.in_cube(1), random.uniform(0.3, 1)));
    }
    count_primitives(scene);
    const auto rays = many(count, [&] {
        return make_ray<T>({0, 0, 3}, random.in_cube(1) - glm::dvec3(0, 0, 3));
    });
    const auto colors = std::get<0>(trace_paths(scene, rays));
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(colors[i].x, T(0.7)) << i;
}
TYPED_TEST(TraceTree, NeverGainsEnergyInAWhiteFurnace) {
    using T = TypeParam;
    Random random(5);
    for (const double mirror : {0.0, 0.1, 0.5}) {
        for (const double ior : {1.5, 0.75, 2.4}) {
            auto scene = unlit<T>(mirror, 1 - mirror, ior, 1);
            for (int i = 0; i < 12; ++i) {
                scene.spheres.push_back(
                    make_sphere<T>(random.in_cube(1.5), random.uniform(0.2, 0.9)));
            }
            count_primitives(scene);
            scene.params.max_bounces = 12;
            const auto rays = many(std::size_t(2000), [&] {
                return make_ray<T>(random.in_cube(2), random.unit_vector());
            });
            const auto colors = std::get<0>(trace_paths(scene, rays));
            double most = 0, sum = 0;
            for (const auto& color : colors) {
                most = std::max(most, double(color.x));
                sum += double(color.x);
            }
            EXPECT_LE(most, 1 + 64 * double(Flat<T>::roundoff)) << mirror << " " << ior;
            EXPECT_GT(sum, 0.3 * double(colors.size()));
        }
    }
}
TYPED_TEST(TraceTree, FocusesABallWhereTheoryHasIt) {
    using T = TypeParam;
    // Rays parallel to the axis, at height h: the ball of radius 1 and index n turns each by
    // 2 (i - r), and it crosses the axis at sin(i) / sin(2 (i - r)); n / (2 (n - 1)) for small h.
    const double n = 1.5;
    for (const double h : {1e-3, 0.1, 0.3, 0.6, 0.9}) {
        const double i = std::asin(h), r = std::asin(h / n);
        const double focus = h / std::sin(2 * (i - r));
        auto scene = unlit<T>(0, 1, n, 1);
        scene.spheres = {make_sphere<T>({0, 0, 0}, 1)};
        // A black target just before and just behind the focus, above the axis and below it.
        typename Flat<T>::Material black{};
        scene.materials.push_back(black);
        const auto upper_half = [&](double z) {
            scene.triangles = {make_triangle<T>({-9, 0, z}, {9, 0, z}, {0, 9, z}, 1)};
            count_primitives(scene);
            const std::vector<ProbeRay<T>> ray{make_ray<T>({0, h, 3}, {0, 0, -1})};
            return std::get<0>(trace_paths(scene, ray))[0].x == 0;
        };
        const double slack = 2e-3;
        EXPECT_TRUE(upper_half(-focus + slack)) << h;
        EXPECT_FALSE(upper_half(-focus - slack)) << h;
        EXPECT_TRUE(h > 0.01 || std::abs(focus - n / (2 * (n - 1))) < 1e-5);
    }
}

}  // namespace

}  // namespace rt::this_file
