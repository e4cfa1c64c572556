// SPDX-License-Identifier: Apache-2.0
//
// kernels/bvh.cl: the same hits, bit for bit, as from testing every primitive in the author's
// order. MIRRORBALL_TEST_RAYS sets how many rays each scene gets.
#include <algorithm>

#include "tests/hit_scenes.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"

namespace rt::this_file {
namespace {

template <typename T>
using Rays = std::vector<ProbeRay<T>>;

/// Most rays per launch, so that a large count takes no more memory.
constexpr std::size_t most_rays = 1 << 17;

/// The same rays, with the primitive they leave renumbered for the hierarchy.
template <typename T>
Rays<T> renumbered(Rays<T> rays, const Numbered<T>& bvh) {
    for (ProbeRay<T>& ray : rays) {
        if (ray.from >= 0) ray.from = bvh.place[std::size_t(ray.from)];
    }
    return rays;
}

/// Hits in the author's numbering.
template <typename T>
std::vector<ProbeHit<T>> closest_hits(const Numbered<T>& numbered, const Rays<T>& rays) {
    auto hits = run<T, ProbeHit<T>>("closest_hit", rays.size(), numbered.scene, rays);
    for (auto& hit : hits) hit.prim = numbered.scene_number(hit.prim);
    return hits;
}

template <typename T>
std::vector<typename Flat<T>::Index> any_hits(const Numbered<T>& numbered, const Rays<T>& rays) {
    return run<T, typename Flat<T>::Index>("any_hit", rays.size(), numbered.scene, rays);
}

/// Ends half the rays that hit something there, or just before.
template <typename T>
void end_at_hits(Rays<T>& rays, const std::vector<ProbeHit<T>>& hits, Random& random) {
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
                             [&] { return some_ray(plain.scene, random); });
            auto moved = renumbered(rays, bvh);
            const auto hits = closest_hits(plain, rays);
            ASSERT_TRUE(same_bits<T>(closest_hits(bvh, moved), hits));
            end_at_hits(rays, hits, random);
            moved = renumbered(rays, bvh);
            const auto any = any_hits(plain, rays);
            ASSERT_EQ(any_hits(bvh, moved), any);
            for (const auto& hit : hits) found += hit.prim != Flat<T>::none ? 1 : 0;
            for (const auto one : any) blocked += one != 0 ? 1 : 0;
        }
        EXPECT_GT(found, ray_count() / 100);
        EXPECT_GT(blocked, ray_count() / 200);
    }
}

/// 0 times infinity, on one axis after the other.
KERNEL_SUITE(BoxEntry);
TYPED_TEST(BoxEntry, IsFoundAlongTheSideOfABox) {
    using T = TypeParam;
    std::vector<ProbeRay<T>> rays;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {0.0, 1.0}) {
            for (const double zero : {0.0, -0.0}) {
                glm::dvec3 origin(0.5), dir(0.5);
                origin[axis] = side;
                dir[axis] = zero;
                rays.push_back(make_ray<T>(origin, dir));
            }
        }
    }
    const typename Flat<T>::BvhNode unit{{0, 0, 0}, 0, {1, 1, 1}, 1};
    const std::vector<typename Flat<T>::BvhNode> boxes(rays.size(), unit);
    EXPECT_EQ((run<T, T>("meets_box", rays.size(), rays, boxes)), std::vector<T>(rays.size(), 0));
    for (ProbeRay<T>& ray : rays) ray.origin = {ray.origin.x + 3, ray.origin.y, ray.origin.z};
    for (const T entry : run<T, T>("meets_box", rays.size(), rays, boxes)) EXPECT_EQ(entry, -1);
}

}  // namespace
}  // namespace rt::this_file
