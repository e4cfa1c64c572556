// SPDX-License-Identifier: Apache-2.0
//
// Hierarchies change nothing: the same hits, bit for bit, as from testing every primitive in the
// author's order. MIRRORBALL_TEST_RAYS sets how many rays each scene gets.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "host/parallel.h"
#include "host/trace/closest_hit.h"
#include "tests/hit_scenes.h"

namespace rt {
namespace {

template <typename T>
bool same(T a, T b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename T>
class Hits : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Hits, Precisions);

TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitive) {
    using T = TypeParam;
    for (const HitScene& made_of : hit_scenes()) {
        SCOPED_TRACE(made_of.name);
        const BothWays<T> both(make_scene(made_of));
        const Numbered<T>&plain = both.plain, &bvh = both.bvh;
        ASSERT_TRUE(plain.scene.nodes.empty());
        ASSERT_FALSE(bvh.scene.nodes.empty());
        const auto plain_view = trace::view_of(plain.scene), bvh_view = trace::view_of(bvh.scene);
        std::atomic<std::size_t> differ = 0, hits = 0, ties = 0;
        constexpr std::size_t run = 1000;
        for_each_run(ray_count(), run, available_cores(), [&](std::size_t first, std::size_t last) {
            Random random(first + 1);
            for (std::size_t i = first; i < last; ++i) {
                trace::Ray<T> ray = some_ray(plain.scene, random);
                trace::Ray<T> twin = ray;
                if (ray.from >= 0) twin.from = bvh.place[std::size_t(ray.from)];
                const auto a = trace::closest_hit(plain_view, ray);
                const auto b = trace::closest_hit(bvh_view, twin);
                hits += a.prim != Flat<T>::none ? 1 : 0;
                ties += a.tied != 0 ? 1 : 0;
                if (a.prim != bvh.listed(b.prim) || !same(a.t, b.t) || !same(a.u, b.u) ||
                    !same(a.v, b.v) || a.tied != b.tied) {
                    ++differ;
                }
                if (random.coin() && a.prim != Flat<T>::none) {
                    ray.t_max = random.coin() ? a.t : std::nextafter(a.t, T(0));
                    twin.t_max = ray.t_max;
                }
                if (trace::any_hit(plain_view, ray) != trace::any_hit(bvh_view, twin)) ++differ;
            }
        });
        EXPECT_EQ(differ, 0u) << ties << " ties";
        EXPECT_GT(hits, ray_count() / 100);
        this->RecordProperty(std::string(made_of.name) + " ties", int(ties));
    }
}

/// Rounding in the frame of a ray grows with its origin's distance from the eye.
TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitiveFromFarAway) {
    using T = TypeParam;
    Scene scene;
    scene.materials.emplace_back();
    add_floor(scene, 8, 1);
    const BothWays<T> both(scene);
    const Numbered<T>&plain = both.plain, &bvh = both.bvh;
    const auto plain_view = trace::view_of(plain.scene), bvh_view = trace::view_of(bvh.scene);
    Random random(21);
    std::size_t differ = 0, hits = 0;
    for (std::size_t i = 0; i < ray_count(); ++i) {
        const auto& triangles = plain.scene.triangles;
        const auto& triangle = triangles[std::size_t(random.index(int(triangles.size())))];
        const glm::dvec3 way = random.unit_vector();
        trace::Ray<T> ray{};
        ray.origin = Vec3<T>(in_double(triangle.p0) - 1000.0 * way);
        ray.dir = trace::normalize3(Vec3<T>(in_double(triangle.p0)) - ray.origin);
        ray.from = Flat<T>::none;
        const auto a = trace::closest_hit(plain_view, ray), b = trace::closest_hit(bvh_view, ray);
        differ += a.prim != bvh.listed(b.prim) || !same(a.t, b.t) || a.tied != b.tied ? 1 : 0;
        ray.t_max = a.prim == Flat<T>::none ? T(2000) : a.t;
        differ += trace::any_hit(plain_view, ray) != trace::any_hit(bvh_view, ray) ? 1 : 0;
        hits += a.prim != Flat<T>::none ? 1 : 0;
    }
    EXPECT_EQ(differ, 0u);
    EXPECT_GT(hits, ray_count() / 4);
}

/// 0 times infinity, on one axis after the other.
TYPED_TEST(Hits, AreFoundAlongTheSideOfABox) {
    using T = TypeParam;
    for (int axis = 0; axis < 3; ++axis) {
        trace::Ray<T> ray{};
        ray.dir = Vec3<T>(T(0.5));
        ray.dir[axis] = 0;
        for (const T side : {T(0), T(1)}) {
            trace::BoxRay<T> box_ray = trace::make_box_ray(ray);
            box_ray.low_origin[axis] = box_ray.high_origin[axis] = side;
            const typename Flat<T>::BvhNode unit{{0, 0, 0}, 0, {1, 1, 1}, 1};
            EXPECT_EQ(trace::enter_box(box_ray, unit), T(0)) << axis;
        }
    }
}

}  // namespace
}  // namespace rt
