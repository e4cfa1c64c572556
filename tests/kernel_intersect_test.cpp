// SPDX-License-Identifier: Apache-2.0
//
// kernels/intersect.cl, spheres and the shear, against 113-bit arithmetic. Tolerances are in
// roundoffs (half an ulp of 1) and close to the largest error found; the regimes are those of
// docs/numerics.md.
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 60000;

template <typename T>
using Sphere = typename Flat<T>::Sphere;

/// A ray and a sphere for each item.
template <typename T>
struct SphereCases {
    std::vector<ProbeRay<T>> rays;
    std::vector<Sphere<T>> spheres;

    /// With `on_it`, the ray leaves that very sphere.
    void add(const ProbeRay<T>& ray, const Sphere<T>& sphere, bool on_it = false) {
        rays.push_back(ray);
        if (on_it) rays.back().from = static_cast<Index<T>>(spheres.size());
        spheres.push_back(sphere);
    }
    std::vector<T> device() const {
        return run<T, T>("intersect_sphere", rays.size(), rays, spheres);
    }
};

/// Rays from outside aimed at and a little past a sphere of radius r at distance 1, or from inside.
template <typename T>
SphereCases<T> sphere_cases(Random& random, double r, bool inside) {
    SphereCases<T> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 center = random.in_cube(1);
        const glm::dvec3 origin = inside
                                      ? center + r * random.uniform(0, 0.9) * random.unit_vector()
                                      : center + random.unit_vector();
        const glm::dvec3 target = center + 1.05 * r * random.unit_vector();
        const glm::dvec3 dir = inside ? random.unit_vector() : target - origin;
        cases.add(make_ray<T>(origin, dir), make_sphere<T>(center, r));
    }
    return cases;
}

/// Hit or miss must be right for rays that clear the silhouette by `margin` (of r^2), and the
/// distance must be right to `bar` roundoffs.
template <typename T>
void expect_right_spheres(const SphereCases<T>& cases, double margin, double bar,
                          const std::string& what = "worst") {
    const auto t = cases.device();
    WorstError worst;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const SphereRoots roots = exact_roots(cases.rays[i], cases.spheres[i]);
        if (magnitude(roots.depth) < margin) continue;
        ASSERT_EQ(t[i] > 0, roots.depth > 0 && roots.far > 0) << i;
        if (t[i] > 0) worst.add(relative_error(t[i], roots.near > 0 ? roots.near : roots.far));
    }
    worst.expect_at_most(bar, what);
}

KERNEL_SUITE(IntersectSphere);
TYPED_TEST(IntersectSphere, IsRightForABallNextToTheEye) {
    Random random(1);
    expect_right_spheres(sphere_cases<TypeParam>(random, 0.5, false), 1e-3, 40);
}
TYPED_TEST(IntersectSphere, IsRightAtAHundredthOfTheDistance) {
    Random random(2);
    expect_right_spheres(sphere_cases<TypeParam>(random, 1e-2, false), 1e-2, 8);
}
TYPED_TEST(IntersectSphere, IsRightAtATenThousandthOfTheDistance) {
    Random random(3);
    // The ray's own rounding error is a thousandth of such a sphere.
    expect_right_spheres(sphere_cases<TypeParam>(random, 1e-4, false), 2e-2, 8);
}
TYPED_TEST(IntersectSphere, IsRightFromInside) {
    Random random(4);
    for (const double r : {1.0, 1e3, 1e6}) {
        expect_right_spheres(sphere_cases<TypeParam>(random, r, true), 1e-3, 20,
                             fmt::format("radius_{:g}", r));
    }
}
TYPED_TEST(IntersectSphere, HitsATangentAndMissesTheNextNumber) {
    SphereCases<TypeParam> cases;
    for (const TypeParam y : {TypeParam(1), std::nextafter(TypeParam(1), TypeParam(2))}) {
        ProbeRay<TypeParam> ray = make_ray<TypeParam>({0, 0, 0}, {1, 0, 0});
        ray.origin.y = y;
        cases.add(ray, make_sphere<TypeParam>({5, 0, 0}, 1));
    }
    EXPECT_EQ(cases.device(), (std::vector<TypeParam>{5, -1}));
}
TYPED_TEST(IntersectSphere, BehindOrPastItIsNoHit) {
    SphereCases<TypeParam> cases;
    cases.add(make_ray<TypeParam>({0, 0, 0}, {-1, 0, 0}), make_sphere<TypeParam>({5, 0, 0}, 1));
    cases.add(make_ray<TypeParam>({0, 3, 0}, {1, 0, 0}), make_sphere<TypeParam>({5, 0, 0}, 1));
    for (const TypeParam t : cases.device()) EXPECT_LT(t, 0);
}
TYPED_TEST(IntersectSphere, LeavingItRunsAlongTheChord) {
    SphereCases<TypeParam> cases;
    auto ray = make_ray<TypeParam>({3, 4, 0}, {-1, 0, 0});
    ray.self_hit = 6;
    cases.add(ray, make_sphere<TypeParam>({0, 0, 0}, 5), true);
    ray.self_hit = -6;
    cases.add(ray, make_sphere<TypeParam>({0, 0, 0}, 5), true);
    EXPECT_EQ(cases.device(), (std::vector<TypeParam>{6, -6}));
}
TYPED_TEST(IntersectSphere, AnEyeOnItSeesTheFarSideOrNothing) {
    Random random(5);
    SphereCases<TypeParam> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const double r = random.log_uniform(1e-6, 1e6);
        auto sphere = make_sphere<TypeParam>(r * random.unit_vector(), r);
        sphere.touches = f32::RT_ON;
        auto ray = make_ray<TypeParam>({0, 0, 0}, random.unit_vector());
        ray.from = Flat<TypeParam>::eye;
        cases.add(ray, sphere);
    }
    const auto t = cases.device();
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad chord = 2 * dot(exact(cases.spheres[i].center), exact(cases.rays[i].dir));
        worst.add(error_in_roundoffs(t[i], chord, cases.spheres[i].radius));
    }
    worst.expect_at_most(5);
}
TYPED_TEST(IntersectSphere, OfAHugeOneIsWhereTheExactGroundLies) {
    // The eye stands 1 to 10 above a ball of radius 1e3 to 1e7 and looks down at more than 3
    // degrees. The power is of the exact ball; the center is rounded, which moves the ground by
    // less than the bar.
    Random random(7);
    SphereCases<TypeParam> cases;
    std::vector<Quad> expected;
    while (expected.size() < count) {
        const double r = random.log_uniform(1e3, 1e7), height = random.uniform(1, 10);
        const glm::dvec3 center(0, -(r + height), 0);
        glm::dvec3 dir = random.unit_vector();
        dir.y = -std::abs(dir.y);
        if (dir.y > -0.05) continue;
        auto sphere = make_sphere<TypeParam>(center, r);
        sphere.is_huge = 1;
        sphere.power = static_cast<TypeParam>(height * (2 * r + height));
        const auto ray = make_ray<TypeParam>({0, 0, 0}, dir);
        const Quad3 d = exact(ray.dir);
        const Quad squared = dot(d, d), b = d.y * Quad(center.y) / squared;
        const Quad c = Quad(height) * (2 * Quad(r) + height) / squared;
        if (b * b < 4 * c) continue;  // above the horizon, or nearly so
        expected.push_back(c / (b + square_root(b * b - c)));
        cases.add(ray, sphere);
    }
    const auto t = cases.device();
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) worst.add(relative_error(t[i], expected[i]));
    worst.expect_at_most(60);
}
TYPED_TEST(IntersectSphere, HasTheSameBitsEverywhereOnAnyNumbers) {
    Random random(6);
    SphereCases<TypeParam> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const auto origin = random.any_vector<TypeParam>(), dir = random.any_vector<TypeParam>();
        cases.add({origin, 1, dir, Flat<TypeParam>::eye, random.any_number<TypeParam>()},
                  {random.any_vector<TypeParam>(),
                   random.any_number<TypeParam>(),
                   0,
                   random.index(2),
                   random.any_number<TypeParam>(),
                   random.index(2),
                   {},
                   0},
                  random.index(4) == 0);
    }
    cases.device();
}

KERNEL_SUITE(Component3);
TYPED_TEST(Component3, PicksByNumber) {
    const std::vector<Packed3<TypeParam>> v(3, {7, 8, 9});
    const std::vector<Index<TypeParam>> k{0, 1, 2};
    EXPECT_EQ((run<TypeParam, TypeParam>("component3", 3, v, k)),
              (std::vector<TypeParam>{7, 8, 9}));
}

/// ProbeShear of kernels/probes/probe_structs.h.
template <typename T>
struct ProbeShear {
    Index<T> kx, ky, kz;
    T origin_x, origin_y, origin_z, sx, sy, sz;
};

KERNEL_SUITE(MakeShear);
TYPED_TEST(MakeShear, PutsTheLongestAxisLastAndTurnsTheRayIntoIt) {
    Random random(7);
    std::vector<ProbeRay<TypeParam>> rays;
    for (const double x : {-1., 0., 1.}) {
        for (const double y : {-1., 0., 1.}) {
            for (const double z : {0., 0.5, 1.})
                rays.push_back({{1, 2, 3}, 1, pack<TypeParam>({x, y, z})});
        }
    }
    std::erase_if(rays, [](const auto& ray) { return glm::length(in_double(ray.dir)) < 1; });
    while (rays.size() < count) {
        rays.push_back(make_ray<TypeParam>(random.in_cube(9), random.unit_vector()));
    }
    const auto shears = run<TypeParam, ProbeShear<TypeParam>>("make_shear", rays.size(), rays);
    WorstError worst;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto& s = shears[i];
        const TypeParam *d = &rays[i].dir.x, *o = &rays[i].origin.x;
        ASSERT_EQ((s.kz + 1) % 3, s.kx);
        ASSERT_EQ((s.kx + 1) % 3, s.ky);
        ASSERT_GE(std::abs(d[s.kz]), std::max(std::abs(d[s.kx]), std::abs(d[s.ky])));
        ASSERT_EQ(o[s.kx], s.origin_x);
        ASSERT_EQ(o[s.ky], s.origin_y);
        ASSERT_EQ(o[s.kz], s.origin_z);
        ASSERT_EQ(s.sz, TypeParam(Quad(1) / d[s.kz]));
        worst.add(error_in_roundoffs(s.sx, Quad(d[s.kx]) / d[s.kz], 1));
        worst.add(error_in_roundoffs(s.sy, Quad(d[s.ky]) / d[s.kz], 1));
    }
    worst.expect_at_most(2);
}
TYPED_TEST(MakeShear, AndShearVertexHaveTheSameBitsEverywhere) {
    Random random(8);
    const auto rays = many(count, [&] {
        return ProbeRay<TypeParam>{random.any_vector<TypeParam>(), 1,
                                   random.any_vector<TypeParam>(), 0, 0};
    });
    const auto vertices = many(count, [&] { return random.any_vector<TypeParam>(); });
    run<TypeParam, ProbeShear<TypeParam>>("make_shear", count, rays);
    run<TypeParam, Packed3<TypeParam>>("shear_vertex", count, rays, vertices);
}
TYPED_TEST(MakeShear, PutsPointsOfTheRayOnTheAxis) {
    Random random(9);
    std::vector<ProbeRay<TypeParam>> rays;
    std::vector<Packed3<TypeParam>> points;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 origin = random.in_cube(1), dir = random.unit_vector();
        rays.push_back(make_ray<TypeParam>(origin, dir));
        points.push_back(pack<TypeParam>(origin + random.uniform(0, 4) * dir));
    }
    const auto sheared = run<TypeParam, Packed3<TypeParam>>("shear_vertex", count, rays, points);
    WorstError worst;
    for (const auto& p : sheared) {
        worst.add(error_in_roundoffs(p.x, 0, 4));
        worst.add(error_in_roundoffs(p.y, 0, 4));
    }
    worst.expect_at_most(4);
}

}  // namespace

}  // namespace rt::this_file
