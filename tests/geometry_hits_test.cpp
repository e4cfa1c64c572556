// SPDX-License-Identifier: Apache-2.0
//
// What rays hit on pthreads: the same bits in packets of every width, with hierarchies and by
// testing every primitive; and the same hits as a textbook tracer in long double.
// MIRRORBALL_TEST_RAYS sets how many rays each scene gets.
#include <gtest/gtest.h>

#include <cstring>

#include "host/render/threads_renderer.h"
#include "tests/brute_force.h"
#include "tests/hit_scenes.h"

namespace rt::this_file {
namespace {

template <typename T>
class Hits : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Hits, Precisions);

template <typename T>
using Query = typename Flat<T>::RayQuery;
template <typename T>
using Answer = typename Flat<T>::RayAnswer;

template <typename T>
Query<T> query_of(const ProbeRay<T>& ray) {
    return {ray.origin, ray.t_max, ray.dir, ray.from, {}, ray.self_hit};
}

/// Rays in the author's numbering; every other one is continued from its hit.
template <typename T>
std::vector<Query<T>> some_queries(const FlatScene<T>& scene, std::size_t count) {
    Random random(1);
    return many(count, [&] {
        Query<T> query = query_of(some_ray(scene, random));
        if (random.coin()) query.next = pack<T>(random.unit_vector());
        return query;
    });
}

/// Answers in the author's numbering, with meaningless fields blanked.
template <typename T>
std::vector<Answer<T>> answers(const Numbered<T>& numbered, std::vector<Query<T>> queries,
                               int lanes) {
    for (Query<T>& query : queries) {
        if (query.from >= 0) query.from = numbered.place[std::size_t(query.from)];
    }
    ThreadsOptions options;
    options.kernels.lanes = lanes;
    std::vector<Answer<T>> found(queries.size());
    make_threads_ray_tracer(numbered.scene, options)(queries, found);
    for (Answer<T>& answer : found) {
        answer.prim = numbered.scene_number(answer.prim);
        answer.next_prim = numbered.scene_number(answer.next_prim);
        if (answer.next_prim == Flat<T>::none) answer.next_t = 0;
        if (answer.prim != Flat<T>::none) continue;
        const auto is_blocked = answer.is_blocked;
        answer = {};
        answer.prim = Flat<T>::none;
        answer.is_blocked = is_blocked;
    }
    return found;
}

/// The number of answers that differ in any bit.
template <typename T>
std::size_t differing(const std::vector<Answer<T>>& a, const std::vector<Answer<T>>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        count += std::memcmp(&a[i], &b[i], sizeof a[i]) != 0 ? 1 : 0;
    }
    return count;
}

/// Ends half the rays that hit something there, or just before.
template <typename T>
void end_at_hits(std::vector<Query<T>>& queries, const std::vector<Answer<T>>& hits) {
    Random random(2);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        if (hits[i].prim == Flat<T>::none || random.coin()) continue;
        queries[i].t_max = random.coin() ? hits[i].t : std::nextafter(hits[i].t, T(0));
    }
}

// The widths that are compiled with sanitizers (cmake/native_kernels.cmake); 0: that of a vector.
#ifdef MIRRORBALL_SANITIZED
constexpr int lane_widths[] = {1, 0};
#else
constexpr int lane_widths[] = {1, 2, 4, 8, 16};
#endif

/// Expects the same answers by every method, and returns them.
template <typename T>
std::vector<Answer<T>> expect_one_answer(const BothWays<T>& both,
                                         const std::vector<Query<T>>& queries) {
    const auto plain = answers(both.plain, queries, 1);
    for (const int lanes : lane_widths) {
        EXPECT_EQ(differing<T>(answers(both.plain, queries, lanes), plain), 0u)
            << lanes << " lanes";
        EXPECT_EQ(differing<T>(answers(both.bvh, queries, lanes), plain), 0u)
            << lanes << " lanes, hierarchies";
    }
    return plain;
}

TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitive) {
    using T = TypeParam;
    std::size_t found_next = 0;
    for (const HitScene& made_of : hit_scenes()) {
        SCOPED_TRACE(made_of.name);
        const BothWays<T> both(make_scene(made_of));
        ASSERT_TRUE(both.plain.scene.nodes.empty());
        ASSERT_FALSE(both.bvh.scene.nodes.empty());
        auto queries = some_queries(both.plain.scene, ray_count(5000));
        const auto hits = expect_one_answer(both, queries);
        end_at_hits<T>(queries, hits);
        std::size_t blocked = 0, found = 0;
        for (const auto& answer : expect_one_answer(both, queries)) {
            blocked += answer.is_blocked != 0 ? 1 : 0;
            found += answer.prim != Flat<T>::none ? 1 : 0;
            found_next += answer.prim != Flat<T>::none && answer.next_prim != Flat<T>::none ? 1 : 0;
        }
        EXPECT_GT(found, queries.size() / 100);
        EXPECT_GT(blocked, queries.size() / 200);
    }
    EXPECT_GT(found_next, ray_count(5000) / 10);
}

/// Rounding error in a ray's frame grows with its origin's distance from the eye.
TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitiveFromFarAway) {
    using T = TypeParam;
    Scene scene;
    scene.materials.emplace_back();
    add_floor(scene, 8, 1);
    const BothWays<T> both(scene);
    Random random(21);
    auto queries = many(ray_count(), [&] {
        const auto& triangles = both.plain.scene.triangles;
        const auto& triangle = triangles[std::size_t(random.index(int(triangles.size())))];
        const glm::dvec3 way = random.unit_vector();
        auto ray = make_ray<T>(in_double(triangle.p0) - 1000.0 * way, way);
        ray.t_max = 2000;
        return query_of(ray);
    });
    const auto hits = expect_one_answer(both, queries);
    end_at_hits<T>(queries, hits);
    std::size_t found = 0;
    for (const auto& hit : expect_one_answer(both, queries)) {
        found += hit.prim != Flat<T>::none ? 1 : 0;
    }
    EXPECT_GT(found, ray_count() / 4);
}

/// Rays through the middle that leave no surface.
template <typename T>
std::vector<Query<T>> random_queries(std::size_t count) {
    Random random(3);
    return many(count, [&] {
        const glm::dvec3 origin = random.in_cube(1.5);
        auto ray = make_ray<T>(origin, random.in_cube(1) - origin);
        ray.t_max = static_cast<T>(random.uniform(0.1, 4));
        return query_of(ray);
    });
}

/// How many of the answers could be compared.
struct Compared {
    std::size_t hits = 0, skipped = 0, blocked = 0, unsure = 0;
};

/// Compares an answer with the textbook tracer's, unless rounding decides.
template <typename T>
void compare(const BruteForce& right, const Query<T>& query, const Answer<T>& found, Index<T> prim,
             Compared& compared) {
    if (right.has_doubt_within(right.nearest_end())) {
        ++compared.skipped;
    } else {
        compared.hits += prim >= 0 ? 1 : 0;
        EXPECT_TRUE(right.agrees(prim, found.t))
            << "primitive " << prim << " at " << found.t << ", and the nearest one ends before "
            << double(right.nearest_end());
    }
    if (right.is_unsure_at(query.t_max)) {
        ++compared.unsure;
    } else {
        compared.blocked += found.is_blocked != 0 ? 1 : 0;
        EXPECT_EQ(found.is_blocked != 0, right.is_blocked(query.t_max));
    }
}

TYPED_TEST(Hits, AreTheTextbooks) {
    using T = TypeParam;
    std::size_t hits = 0, blocked = 0;
    for (const HitScene& made_of : hit_scenes()) {
        if (!made_of.is_textbook) continue;
        SCOPED_TRACE(made_of.name);
        const Numbered<T> bvh(flatten<T>(make_scene(made_of)));
        const auto queries = random_queries<T>(ray_count() / 10);
        const auto found = answers(bvh, queries, 0);
        Compared compared;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const BruteForce right(bvh.scene, wide(queries[i].origin), wide(queries[i].dir));
            const auto prim = found[i].prim;
            compare<T>(right, queries[i], found[i], prim < 0 ? prim : bvh.place[std::size_t(prim)],
                       compared);
        }
        const std::size_t few = queries.size() / 20;
        EXPECT_LE(compared.skipped, few);
        EXPECT_LE(compared.unsure, few);
        hits += compared.hits;
        blocked += compared.blocked;
    }
    EXPECT_GT(hits, ray_count() / 8);
    EXPECT_GT(blocked, ray_count() / 8);
}

}  // namespace
}  // namespace rt::this_file
