// SPDX-License-Identifier: Apache-2.0
//
// kernels/whitted.cl: mirror rays against 113-bit geometry, and paths worked out by hand.
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 20000;

template <typename T>
using Counts = typename Flat<T>::RayCounts;

/// Surfaces hit by rays: flat ones first, then ones whose shading normal leans by up to 90 degrees.
template <typename T>
struct Meetings {
    std::vector<ProbeSurface<T>> surfaces;
    std::vector<Packed3<T>> dirs;
    std::vector<Index<T>> prims;

    explicit Meetings(Random& random) {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 face = random.unit_vector();
            glm::dvec3 lean = i < count / 2 ? face : face + 1.2 * random.unit_vector();
            if (glm::dot(lean, face) < 0) lean = -lean;
            surfaces.push_back({pack<T>(random.in_cube(1)), T(0x1p-18),
                                pack<T>(glm::normalize(lean)), 0, pack<T>(face), 0});
            dirs.push_back(pack<T>(random.unit_vector()));
            prims.push_back(static_cast<Index<T>>(i));
        }
    }
    std::vector<ProbeRay<T>> rays() const {
        return run<T, ProbeRay<T>>("mirror_ray", count, surfaces, dirs, prims);
    }
};

KERNEL_SUITE(MirrorRay);
TYPED_TEST(MirrorRay, LeavesOnTheSideItCameFromAndNeverUnderTheFace) {
    Random random(1);
    const Meetings<TypeParam> given(random);
    const auto rays = given.rays();
    std::size_t about_the_face = 0;
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 d = exact(given.dirs[i]), face = exact(given.surfaces[i].geometric);
        const Quad3 n = exact(given.surfaces[i].normal), p = exact(given.surfaces[i].point);
        const Quad arriving = dot(d, face);
        if (magnitude(arriving) < 8 * Quad(Flat<TypeParam>::roundoff)) continue;
        ASSERT_TRUE(dot(exact(rays[i].dir), face) * arriving < 0) << i;
        ASSERT_TRUE(dot(exact(rays[i].origin) - p, face) * arriving < 0) << i;
        ASSERT_EQ(rays[i].from, given.prims[i]);
        ASSERT_TRUE(std::isinf(rays[i].t_max));
        const Quad3 about_n = d - 2 * dot(d, n) * n, about_face = d - 2 * dot(d, face) * face;
        const Quad clear = dot(about_n, face) * arriving;
        if (magnitude(clear) < 64 * Quad(Flat<TypeParam>::roundoff)) continue;
        about_the_face += clear > 0;
        worst.add(vector_error<TypeParam>(rays[i].dir, unit(clear < 0 ? about_n : about_face), 1));
    }
    worst.expect_at_most(3.5);
    EXPECT_GT(about_the_face, 500u);
}

/// Two mirrors that send a ray from the origin along -z to +x, and then up to the background. All
/// numbers are dyadic, so the colors are exact.
template <typename T>
FlatScene<T> two_mirrors(int max_bounces) {
    FlatScene<T> scene{};
    scene.triangles = {make_triangle<T>({-2, -4, 1}, {2, -4, -3}, {0, 8, -1}, 0),
                       make_triangle<T>({0, -4, -3}, {4, -4, 1}, {2, 8, -1}, 1)};
    typename Flat<T>::Material first{}, second{};
    first.ambient = {T(0.5), 0, T(0.25)};
    first.mirror = {T(0.5), T(0.5), T(0.25)};
    second.ambient = {0, T(0.25), T(0.5)};
    second.mirror = {T(0.25), T(0.5), T(0.5)};
    scene.materials = {first, second};
    scene.params.ambient_light = {1, 1, T(0.5)};
    scene.params.background = {2, 1, 4};
    scene.params.max_bounces = max_bounces;
    count_primitives(scene);
    return scene;
}

KERNEL_SUITE(TracePath);
TYPED_TEST(TracePath, MultipliesMirrorsAlongTwoBounces) {
    struct Case {
        int max_bounces;
        Packed3<TypeParam> color;
        std::uint64_t mirror_rays;
    };
    const TypeParam a = TypeParam(0.125), b = TypeParam(0.0625), c = TypeParam(0.5);
    // kaIa; + km1 (ka2 Ia); + km1 km2 background
    const std::vector<Case> cases{{0, {c, 0, a}, 0},
                                  {1, {c, a, a + b}, 1},
                                  {2, {c + 2 * a, a + 2 * a, a + b + c}, 2},
                                  {8, {c + 2 * a, a + 2 * a, a + b + c}, 2}};
    const std::vector<ProbeRay<TypeParam>> ray{make_ray<TypeParam>({0, 0, 0}, {0, 0, -1})};
    for (const auto& [max_bounces, color, mirror_rays] : cases) {
        const auto scene = two_mirrors<TypeParam>(max_bounces);
        const auto [colors, counts] =
            run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>("trace_path", 1, scene, ray);
        EXPECT_TRUE(same_bits<TypeParam>(colors, std::vector{color})) << max_bounces;
        EXPECT_EQ(counts[0].mirror, mirror_rays);
        EXPECT_EQ(counts[0].shadow, 0u);
    }
}
TYPED_TEST(TracePath, SeesTheBackgroundWhereItMisses) {
    const auto scene = two_mirrors<TypeParam>(8);
    const std::vector<ProbeRay<TypeParam>> ray{make_ray<TypeParam>({0, 0, 0}, {0, 1, 0})};
    const auto [colors, counts] =
        run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>("trace_path", 1, scene, ray);
    EXPECT_TRUE(same_bits<TypeParam>(colors, std::vector{scene.params.background}));
    EXPECT_EQ(counts[0].mirror, 0u);
}
TYPED_TEST(TracePath, LightsTheBackOfATwoSidedSurfaceAlone) {
    for (const int two_sided : {0, 1}) {
        FlatScene<TypeParam> scene{};
        // Its normal points down at -z, eye and light are above.
        scene.triangles = {make_triangle<TypeParam>({-4, -4, -2}, {0, 8, -2}, {4, -4, -2})};
        scene.materials.resize(1);
        scene.materials[0].diffuse = {1, 1, 1};
        scene.materials[0].two_sided = two_sided;
        scene.lights = {{{0, 0, 6}, 0, {1, TypeParam(0.5), 0}, 0}};
        count_primitives(scene);
        const std::vector<ProbeRay<TypeParam>> ray{make_ray<TypeParam>({0, 0, 0}, {0, 0, -1})};
        const auto [colors, counts] =
            run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>("trace_path", 1, scene, ray);
        EXPECT_EQ(colors[0].x, TypeParam(two_sided));
        EXPECT_EQ(colors[0].y, TypeParam(0.5) * two_sided);
        EXPECT_EQ(counts[0].shadow, std::uint64_t(two_sided));
    }
}

/// Spheres, cones and triangles, some with vertex normals, mirrors and glass, with two lights and a
/// camera.
template <typename T>
FlatScene<T> shiny_crowd() {
    Random random(3);
    auto scene = crowd<T>(random);
    const auto any = [&] { return pack<T>(random.unit_vector()); };
    const auto color = [&] { return pack<T>(random.in_cube(0.5) + glm::dvec3(0.5)); };
    for (int i = 0; i < 8; ++i) {
        scene.cones.push_back({pack<T>(random.in_cube(2)), T(0.4), any(), T(0.9),
                               T(0.3 * random.index(3) - 0.3), 0, 0, 0});
    }
    scene.materials.clear();
    for (Index<T> i = 0; i < 6; ++i) {
        const auto clear = i % 3 == 0 ? Packed3<T>{} : pack<T>(0.5 * in_double(color()));
        scene.materials.push_back({color(), T(5 << i), color(), i % 2, color(),
                                   T(random.uniform(0.6, 2)), color(), 0, clear, 0});
        scene.vertex_normals.push_back({any(), 0, any(), 0, any(), 0});
        scene.triangles[static_cast<std::size_t>(i)].smooth = i;
    }
    for (auto& sphere : scene.spheres) sphere.material = random.index(6);
    for (auto& cone : scene.cones) cone.material = random.index(6);
    for (auto& triangle : scene.triangles) triangle.material = random.index(6);
    scene.lights = {{{5, 6, 7}, 0, {1, 1, 1}, 0}, {{-3, 5, 0}, 0, {T(0.5), 1, T(0.25)}, 0}};
    scene.params.direction = {0, 0, -1};
    scene.params.direction_dx = {T(0.02), 0, 0};
    scene.params.direction_dy = {0, T(0.02), 0};
    scene.params.width = 80;
    scene.params.height = 60;
    scene.params.grid = 2;
    scene.params.samples = 4;
    scene.params.max_bounces = 6;
    scene.params.background = {T(0.1), T(0.2), T(0.3)};
    scene.params.ambient_light = {T(0.5), T(0.5), T(0.5)};
    count_primitives(scene);
    return scene;
}

KERNEL_SUITE(TraceSample);
TYPED_TEST(TraceSample, HasTheSameBitsEverywhereInACrowdOfGlassAndMirrors) {
    const auto scene = shiny_crowd<TypeParam>();
    const auto& f = scene.params;
    std::vector<Index<TypeParam>> x, y, k;
    for (Index<TypeParam> i = 0; i < f.width * f.height * 4; ++i) {
        x.push_back(i % f.width);
        y.push_back(i / f.width % f.height);
        k.push_back(i / (f.width * f.height));
    }
    const auto counts = std::get<1>(run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>(
        "trace_sample", x.size(), scene, x, y, k));
    std::uint64_t mirror = 0, shadow = 0, transmitted = 0;
    for (const auto& used : counts) {
        mirror += used.mirror;
        shadow += used.shadow;
        transmitted += used.transmitted;
    }
    for (const std::uint64_t rays : {mirror, shadow, transmitted}) EXPECT_GT(rays, 4000u);
}

/// The weighted means of the pixels' samples, in quad.
template <typename T>
std::vector<Quad3> means_of_samples(const FlatScene<T>& scene, const std::vector<Index<T>>& x,
                                    const std::vector<Index<T>>& y) {
    std::vector<Quad3> sums(x.size(), {0, 0, 0});
    std::vector<Quad> totals(x.size(), 0);
    for (Index<T> k = 0; k < scene.params.samples; ++k) {
        const std::vector<Index<T>> same_k(x.size(), k);
        const auto colors = std::get<0>(
            run<T, Packed3<T>, Counts<T>>("trace_sample", x.size(), scene, x, y, same_k));
        const auto weights = std::get<4>(
            run<T, T, T, T, T, T>("sample", x.size(), std::vector{scene.params}, x, y, same_k));
        for (std::size_t i = 0; i < x.size(); ++i) {
            sums[i] = sums[i] + Quad(weights[i]) * exact(colors[i]);
            totals[i] += weights[i];
        }
    }
    for (std::size_t i = 0; i < x.size(); ++i) sums[i] = Quad(1) / totals[i] * sums[i];
    return sums;
}

KERNEL_SUITE(TracePixel);
TYPED_TEST(TracePixel, IsTheWeighedMeanOfItsSamples) {
    using T = TypeParam;
    auto scene = shiny_crowd<T>();
    for (const int filter : {0, 1, 2, 3}) {
        scene.params.filter = filter;
        const bool is_sobol = filter % 2 == 0;
        scene.params.sampling = is_sobol ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
        scene.params.grid = is_sobol ? 0 : 4;
        scene.params.samples = 16;
        std::vector<Index<T>> x, y;
        for (Index<T> i = 0; i < 400; ++i) {
            x.push_back(i * 7 % scene.params.width);
            y.push_back(i * 3 % scene.params.height);
        }
        const auto colors = run<T, Packed3<T>>("trace_pixel", x.size(), scene, x, y);
        const auto means = means_of_samples(scene, x, y);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Quad3 mean = means[i];
            ASSERT_NEAR(double(colors[i].x), double(mean.x), 32 * double(Flat<T>::roundoff)) << i;
            ASSERT_NEAR(double(colors[i].y), double(mean.y), 32 * double(Flat<T>::roundoff)) << i;
            ASSERT_NEAR(double(colors[i].z), double(mean.z), 32 * double(Flat<T>::roundoff)) << i;
        }
    }
}

TYPED_TEST(TracePixel, DoesNotDriftOverManySamples) {
    using T = TypeParam;
    FlatScene<T> scene{};
    scene.params = shiny_crowd<T>().params;
    count_primitives(scene);
    scene.params.grid = 64;
    scene.params.samples = 4096;
    for (const double gray : {0.0123, 0.1, 0.3, 0.7, 0.9876}) {
        scene.params.background = pack<T>(glm::dvec3(gray));
        const std::vector<Index<T>> pixels(16, 3);
        for (const auto& color : run<T, Packed3<T>>("trace_pixel", 16, scene, pixels, pixels)) {
            ASSERT_NEAR(double(color.x), gray, 80 * double(Flat<T>::roundoff) * gray);
        }
    }
}

}  // namespace

}  // namespace rt::this_file
