// SPDX-License-Identifier: Apache-2.0
//
// kernels/closest_hit.cl: one ray against all primitives, and the rule for ties (surfaces within 32
// half-ulps of the nearest are one; its lowest index is hit), whatever the order of the primitives.
#include <numeric>

#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

template <typename T>
using Hit = ProbeHit<T>;

/// The right answer for one ray, by the definition of the rule: from the device's distances to all
/// primitives.
template <typename T>
struct AllHits {
    std::vector<std::vector<T>> distances;  ///< by primitive, then by ray

    AllHits(const FlatScene<T>& scene, const std::vector<ProbeRay<T>>& rays) {
        const std::size_t count = rays.size();
        for (const auto& sphere : scene.spheres) {
            auto own = rays;  // the probe's spheres are numbered like its rays
            for (std::size_t i = 0; i < count; ++i) {
                own[i].from = leaves_next(rays[i]) ? static_cast<Index<T>>(i) : Flat<T>::none;
            }
            distances.push_back(
                run<T, T>("intersect_sphere", count, own, std::vector(count, sphere)));
        }
        for (const auto& triangle : scene.triangles) {
            const auto hits =
                run<T, Hit<T>>("intersect_triangle", count, rays, std::vector(count, triangle));
            std::vector<T> own;
            for (std::size_t i = 0; i < count; ++i)
                own.push_back(leaves_next(rays[i]) ? -1 : hits[i].t);
            distances.push_back(own);
        }
    }
    /// Whether it leaves the primitive that is tested next.
    bool leaves_next(const ProbeRay<T>& ray) const {
        return ray.from == static_cast<Index<T>>(distances.size());
    }
    T distance(std::size_t ray, std::size_t prim) const { return distances[prim][ray]; }
    /// The lowest index hit within (0, limit], or none.
    Index<T> first_within(std::size_t ray, T limit) const {
        for (std::size_t prim = 0; prim < distances.size(); ++prim) {
            const T t = distance(ray, prim);
            if (t > 0 && t <= limit) return static_cast<Index<T>>(prim);
        }
        return Flat<T>::none;
    }
    T nearest(std::size_t ray) const {
        T best = std::numeric_limits<T>::infinity();
        for (std::size_t prim = 0; prim < distances.size(); ++prim) {
            const T t = distance(ray, prim);
            if (t > 0 && t < best) best = t;
        }
        return best;
    }
    T tie(std::size_t ray) const { return nearest(ray) * (1 + 32 * Flat<T>::roundoff); }
};

KERNEL_SUITE(ClosestHit);
TYPED_TEST(ClosestHit, IsTheLowestIndexAmongTheNearest) {
    Random random(1);
    const auto scene = crowd<TypeParam>(random);
    const auto rays = rays_about<TypeParam>(random, 20000);
    const AllHits<TypeParam> all(scene, rays);
    const auto hits = run<TypeParam, Hit<TypeParam>>("closest_hit", rays.size(), scene, rays);
    int found = 0, ties = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto prim = all.first_within(i, all.tie(i));
        ASSERT_EQ(hits[i].prim, prim) << i;
        if (prim == Flat<TypeParam>::none) continue;
        ++found;
        ASSERT_EQ(hits[i].t, all.distance(i, static_cast<std::size_t>(prim)));
        ties += hits[i].tied != 0;
    }
    EXPECT_GT(found, 5000);
    EXPECT_GT(ties, 100);
}

/// Triangles across the z axis at these distances, each rotated a little.
template <typename T>
std::vector<typename Flat<T>::Triangle> stack(const std::vector<T>& distances) {
    std::vector<typename Flat<T>::Triangle> triangles;
    for (const T z : distances) {
        const auto n = double(triangles.size());
        auto triangle = make_triangle<T>({-9 - n, -9, z}, {9, -9 - n, z}, {0, 9, z}, int(n));
        triangles.push_back(triangle);
    }
    return triangles;
}

TYPED_TEST(ClosestHit, DoesNotDependOnTheOrderOfATie) {
    // Each is within 32 half-ulps of its neighbors, but the last two are not of the first: a rule
    // that went by neighbors would depend on the order.
    const TypeParam ulp = std::numeric_limits<TypeParam>::epsilon();
    std::vector<TypeParam> distances;
    for (const int ulps : {0, 6, 12, 20, 28}) distances.push_back(1 + TypeParam(ulps) * ulp);
    const auto triangles = stack<TypeParam>(distances);
    std::vector<std::size_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const std::vector<ProbeRay<TypeParam>> ray{make_ray<TypeParam>({0, 0, 0}, {0, 0, 1})};
    do {
        FlatScene<TypeParam> scene{};
        for (const std::size_t i : order) scene.triangles.push_back(triangles[i]);
        count_primitives(scene);
        const auto hit = run<TypeParam, Hit<TypeParam>>("closest_hit", 1, scene, ray)[0];
        // The first in this order among the three that tie with the nearest.
        const auto first =
            std::find_if(order.begin(), order.end(), [](std::size_t i) { return i < 3; });
        ASSERT_EQ(hit.prim, first - order.begin());
        ASSERT_EQ(hit.t, distances[*first]);
        ASSERT_EQ(hit.tied, 1);
    } while (std::next_permutation(order.begin(), order.end()));
}
TYPED_TEST(ClosestHit, ShowsTheFirstOfCoplanarTrianglesOnWhicheverDiagonal) {
    // A tilted square split along one diagonal, then along the other with reversed winding.
    const glm::dvec3 a{-1, -1.1, 3.1}, b{1.2, -1, 2.7}, c{1, 1.3, 3.3};
    const glm::dvec3 d = a + (c - b);
    for (const bool turned : {false, true}) {
        FlatScene<TypeParam> scene{};
        scene.triangles = {make_triangle<TypeParam>(a, b, c), make_triangle<TypeParam>(a, c, d),
                           make_triangle<TypeParam>(d, b, a), make_triangle<TypeParam>(b, d, c)};
        if (turned)
            std::rotate(scene.triangles.begin(), scene.triangles.begin() + 2,
                        scene.triangles.end());
        count_primitives(scene);
        Random random(2);
        const auto rays = many(20000, [&] {
            const glm::dvec3 p =
                a + random.uniform(0.02, 0.98) * (b - a) + random.uniform(0.02, 0.98) * (d - a);
            // Near the square, too, where rounding moves its triangles as much as far from it.
            return make_ray<TypeParam>((1 - random.log_uniform(1e-4, 1)) * p, p);
        });
        const auto hits = run<TypeParam, Hit<TypeParam>>("closest_hit", rays.size(), scene, rays);
        for (const auto& hit : hits) ASSERT_TRUE(hit.prim == 0 || hit.prim == 1) << hit.prim;
    }
}

/// Two triangles in the planes z = -3 and z = -4, and a ray towards them that rounding starts in
/// front of the nearer one, with and without leaving it.
template <typename T>
struct Doorstep {
    FlatScene<T> scene{};
    std::vector<ProbeRay<T>> rays;

    Doorstep() {
        scene.triangles = {make_triangle<T>({-1, -1, -3}, {3, -1, -3}, {-1, 3, -3}),
                           make_triangle<T>({-1, -1, -4}, {3, -1, -4}, {-1, 3, -4})};
        count_primitives(scene);
        const T before = std::nextafter(T(-3), T(0));
        rays.assign(2, make_ray<T>({0, 0, double(before)}, {0, 0, -1}));
        rays[1].from = 0;
    }
};

TYPED_TEST(ClosestHit, SkipsTheTriangleItLeaves) {
    const Doorstep<TypeParam> at;
    const auto hits = run<TypeParam, Hit<TypeParam>>("closest_hit", 2, at.scene, at.rays);
    EXPECT_EQ(hits[0].prim, 0);
    EXPECT_EQ(hits[1].prim, 1);
}

/// The deepest hierarchy there may be: each inner node holds the next and a leaf. All boxes are
/// alike, so that every leaf but one waits on the stack. Triangle i is about (3 i, 0, 1).
template <typename T>
struct DeepestHierarchy {
    FlatScene<T> scene{};
    std::vector<ProbeRay<T>> rays;  ///< one at each triangle

    DeepestHierarchy() {
        for (int i = 0; i <= max_bvh_depth; ++i) {
            const double x = 3 * i;
            scene.triangles.push_back(
                make_triangle<T>({x - 1, -1, 1}, {x + 1, -1, 1}, {x, 1, 1}, i));
            rays.push_back(make_ray<T>({x, 0, 0}, {0, 0, 1}));
            rays.back().t_max = 1;
        }
        count_primitives(scene);
        const auto node = [](int first, int count) {
            return typename Flat<T>::BvhNode{
                {-999, -999, -999}, Index<T>(first), {999, 999, 999}, Index<T>(count)};
        };
        scene.nodes = {node(0, 0), node(2, 0)};
        for (int i = 0; i < max_bvh_depth; ++i) {
            const bool is_last = i == max_bvh_depth - 1;
            scene.nodes.push_back(is_last ? node(max_bvh_depth, 1) : node(2 * i + 4, 0));
            scene.nodes.push_back(node(i, 1));
        }
        scene.params.triangle_root = 1;
    }
};

TYPED_TEST(ClosestHit, VisitsEveryLeafOfTheDeepestHierarchy) {
    const DeepestHierarchy<TypeParam> deepest;
    const auto hits = run<TypeParam, Hit<TypeParam>>("closest_hit", deepest.rays.size(),
                                                     deepest.scene, deepest.rays);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_EQ(hits[i].prim, static_cast<Index<TypeParam>>(i));
    }
}

KERNEL_SUITE(AnyHit);
TYPED_TEST(AnyHit, VisitsEveryLeafOfTheDeepestHierarchy) {
    const DeepestHierarchy<TypeParam> deepest;
    const auto found = run<TypeParam, Index<TypeParam>>("any_hit", deepest.rays.size(),
                                                        deepest.scene, deepest.rays);
    EXPECT_EQ(std::count(found.begin(), found.end(), 0), 0);
}
TYPED_TEST(AnyHit, SkipsTheTriangleItLeaves) {
    Doorstep<TypeParam> at;
    for (auto& ray : at.rays) ray.t_max = TypeParam(0.5);
    const auto found = run<TypeParam, Index<TypeParam>>("any_hit", 2, at.scene, at.rays);
    EXPECT_NE(found[0], 0);
    EXPECT_EQ(found[1], 0);
}
TYPED_TEST(AnyHit, FindsWhateverLiesWithinReach) {
    Random random(4);
    const auto scene = crowd<TypeParam>(random);
    auto rays = rays_about<TypeParam>(random, 20000);
    const AllHits<TypeParam> all(scene, rays);
    // Half the rays end exactly on the nearest triangle or well behind the nearest ball (ending on
    // it, the light would be on it), or one number before.
    for (std::size_t i = 0; i < rays.size(); i += 2) {
        const auto prim = all.first_within(i, all.nearest(i));
        const bool is_ball = prim < static_cast<Index<TypeParam>>(scene.spheres.size());
        rays[i].t_max = all.nearest(i) * (is_ball ? TypeParam(1.01) : TypeParam(1));
        if (i % 4 == 0) rays[i].t_max = std::nextafter(all.nearest(i), TypeParam(0));
    }
    const auto found = run<TypeParam, Index<TypeParam>>("any_hit", rays.size(), scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(found[i] != 0, all.nearest(i) <= rays[i].t_max && std::isfinite(all.nearest(i)))
            << i;
    }
}
/// From a point to a light, as shadow rays go.
template <typename T>
ProbeRay<T> ray_to_light(const glm::dvec3& from, const glm::dvec3& light) {
    auto ray = make_ray<T>(from, light - from);
    ray.t_max = static_cast<T>(glm::length(light - from)) * (1 - 16 * Flat<T>::roundoff);
    return ray;
}

/// How many of the rays towards light 0 are blocked by a primitive on which it lies.
template <typename T>
std::ptrdiff_t blocked(FlatScene<T>& scene, const std::vector<ProbeRay<T>>& rays) {
    const auto bits = Index<T>{f32::RT_ON} << f32::RT_TOUCHES_FIRST_LIGHT;
    for (auto& sphere : scene.spheres) sphere.touches = bits;
    for (auto& cone : scene.cones) cone.touches = bits;
    count_primitives(scene);
    const auto found = run<T, Index<T>>("any_hit", rays.size(), scene, rays);
    return std::count(found.begin(), found.end(), Index<T>(1));
}

TYPED_TEST(AnyHit, OfTheBallALightLiesOnIsWhatLiesBetween) {
    // Lights all over a ball, seen from points outside on their side of it, from points inside, and
    // from the other side.
    Random random(11);
    FlatScene<TypeParam> scene{};
    scene.spheres = {make_sphere<TypeParam>({0, 0, 0}, 1)};
    const auto rays = [&](double least, double most) {
        return many(20000, [&] {
            const glm::dvec3 light = random.unit_vector();
            const glm::dvec3 aside = glm::cross(light, random.unit_vector());
            const double height = least + random.log_uniform(1e-3, 1) * (most - least);
            return ray_to_light<TypeParam>(height * light + 0.01 * aside, light);
        });
    };
    EXPECT_EQ(blocked(scene, rays(1, 10)), 0);
    EXPECT_EQ(blocked(scene, rays(0.9, -0.9)), 0);
    EXPECT_EQ(blocked(scene, rays(-1.1, -10)), 20000);
}

TYPED_TEST(AnyHit, OfTheConeALightLiesOnIsWhatLiesBetween) {
    // Lights on a cylinder and on a funnel, straight out from them, inside, and on the other side.
    Random random(12);
    for (const double apex_radius : {1.0, 0.25}) {
        FlatScene<TypeParam> scene{};
        scene.cones = {make_cone<TypeParam>({0, 0, -1}, 1, {0, 0, 1}, apex_radius)};
        const auto rays = [&](double least, double most) {
            return many(20000, [&] {
                const double angle = random.uniform(0, 6.28), z = random.uniform(-0.9, 0.9);
                const double radius = 1 + (apex_radius - 1) * (z + 1) / 2;
                const glm::dvec3 out{std::cos(angle), std::sin(angle), 0};
                const double scale = least + random.log_uniform(1e-2, 1) * (most - least);
                return ray_to_light<TypeParam>(glm::dvec3(0, 0, z) + scale * radius * out,
                                               glm::dvec3(0, 0, z) + radius * out);
            });
        };
        EXPECT_EQ(blocked(scene, rays(1, 10)), 0);
        EXPECT_EQ(blocked(scene, rays(0.9, -0.9)), 0);
        EXPECT_EQ(blocked(scene, rays(-1.1, -10)), 20000);
    }
}

TYPED_TEST(AnyHit, FindsNothingInAnEmptyScene) {
    const FlatScene<TypeParam> scene{};
    const std::vector<ProbeRay<TypeParam>> rays{make_ray<TypeParam>({0, 0, 0}, {0, 0, 1})};
    EXPECT_EQ((run<TypeParam, Index<TypeParam>>("any_hit", 1, scene, rays)[0]), 0);
    const auto hit = run<TypeParam, Hit<TypeParam>>("closest_hit", 1, scene, rays)[0];
    EXPECT_EQ(hit.prim, Flat<TypeParam>::none);
}

}  // namespace

}  // namespace rt::this_file
