// SPDX-License-Identifier: Apache-2.0
//
// kernels/bvh.cl on a device: the same hits, bit for bit, as from testing every primitive in the
// author's order, and the same as the twin's. MIRRORBALL_TEST_RAYS sets how many rays each scene
// gets.
#include <algorithm>

#include "host/trace/closest_hit.h"
#include "tests/hit_scenes.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"

namespace rt {
namespace {

template <typename T>
using Rays = std::vector<ProbeRay<T>>;

/// Rays of one launch, so that a large count takes no more memory.
constexpr std::size_t most_rays = 1 << 17;

/// The same rays, with what they leave numbered as in the hierarchy.
template <typename T>
Rays<T> renumbered(Rays<T> rays, const Numbered<T>& bvh) {
    for (ProbeRay<T>& ray : rays) {
        if (ray.from >= 0) ray.from = bvh.place[std::size_t(ray.from)];
    }
    return rays;
}

/// Hits with the author's numbers.
template <typename T>
std::vector<trace::Hit<T>> closest_hits(const Numbered<T>& numbered, const Rays<T>& rays) {
    auto hits = run<T, trace::Hit<T>>("closest_hit", rays.size(), numbered.scene, rays);
    for (auto& hit : hits) hit.prim = numbered.listed(hit.prim);
    return hits;
}

template <typename T>
std::vector<typename Flat<T>::Index> any_hits(const Numbered<T>& numbered, const Rays<T>& rays) {
    return run<T, typename Flat<T>::Index>("any_hit", rays.size(), numbered.scene, rays);
}

/// Ends half the rays that hit something there, or just before.
template <typename T>
void end_at_hits(Rays<T>& rays, const std::vector<trace::Hit<T>>& hits, Random& random) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].prim == Flat<T>::none || random.coin()) continue;
        rays[i].t_max = random.coin() ? hits[i].t : std::nextafter(hits[i].t, T(0));
    }
}

KERNEL_SUITE(DeviceHits);
TYPED_TEST(DeviceHits, AreThoseOfTestingEveryPrimitive) {
    using T = TypeParam;
    for (const HitScene& made_of : hit_scenes()) {
        SCOPED_TRACE(made_of.name);
        const BothWays<T> both(make_scene(made_of));
        const Numbered<T>&plain = both.plain, &bvh = both.bvh;
        ASSERT_TRUE(plain.scene.nodes.empty());
        ASSERT_FALSE(bvh.scene.nodes.empty());
        Random random(31);
        std::size_t found = 0, blocked = 0;
        for (std::size_t done = 0; done < ray_count(); done += most_rays) {
            auto rays = many(std::min(ray_count() - done, most_rays),
                             [&] { return pack(some_ray(plain.scene, random)); });
            auto twins = renumbered(rays, bvh);
            const auto hits = closest_hits(plain, rays);
            ASSERT_TRUE(same_bits<T>(closest_hits(bvh, twins), hits));
            ASSERT_TRUE(same_bits<T>(hits, for_each_item(rays.size(), [&](std::size_t i) {
                                         return trace::closest_hit(trace::view_of(plain.scene),
                                                                   unpack(rays[i]));
                                     })));
            end_at_hits(rays, hits, random);
            twins = renumbered(rays, bvh);
            const auto any = any_hits(plain, rays);
            ASSERT_EQ(any_hits(bvh, twins), any);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const auto view = trace::view_of(plain.scene);
                ASSERT_EQ(any[i] != 0, trace::any_hit(view, unpack(rays[i]))) << i;
            }
            for (const auto& hit : hits) found += hit.prim != Flat<T>::none ? 1 : 0;
            for (const auto one : any) blocked += one != 0 ? 1 : 0;
        }
        EXPECT_GT(found, ray_count() / 100);
        EXPECT_GT(blocked, ray_count() / 200);
    }
}

}  // namespace
}  // namespace rt
