// SPDX-License-Identifier: Apache-2.0
//
// host/flatten/bvh: every box in one leaf, boxes inside their parents, bounded depth, and the same
// result for any number of threads, whatever the boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "host/flatten/bvh.h"
#include "host/flatten/flat_scene.h"
#include "host/stress/stress_scenes.h"
#include "tests/test_random.h"

namespace rt::this_file {
namespace {

template <typename T>
using Boxes = std::vector<BvhBox<T>>;

template <typename T>
BvhBox<T> box_about(const glm::dvec3& center, double half) {
    BvhBox<T> box{};
    box.low = {T(center.x - half), T(center.y - half), T(center.z - half)};
    box.high = {T(center.x + half), T(center.y + half), T(center.z + half)};
    return box;
}

struct Cloud {
    const char* name;
    std::size_t count;
    std::function<glm::dvec3(Random&, double)> center;  ///< of a box at a fraction of the count
    std::function<double(Random&, double)> half;
};

const std::vector<Cloud>& clouds() {
    const auto tiny = [](Random&, double) { return 1e-3; };
    const auto spread = [](Random& random, double) { return random.in_cube(1); };
    static const std::vector<Cloud> all{
        {"one", 1, spread, tiny},
        {"two", 2, spread, tiny},
        {"nine", 9, spread, tiny},
        {"soup", 100000, spread, [](Random& random, double) { return random.uniform(0, 0.02); }},
        {"coincident", 1000000, [](Random&, double) { return glm::dvec3(1, 2, 3); }, tiny},
        {"concentric", 100000, [](Random&, double) { return glm::dvec3(0); },
         [](Random& random, double) { return random.log_uniform(1e-6, 1e6); }},
        {"collinear", 100000, [](Random&, double at) { return glm::dvec3(at, 0, 0); }, tiny},
        {"geometric", 20000,
         [](Random&, double at) { return glm::dvec3(std::exp2(-120 * at), 0, 0); },
         [](Random&, double at) { return 0.25 * std::exp2(-120 * at); }},
        {"huge and small", 50000,
         [](Random& random, double) {
             return random.log_uniform(1e-8, 1e8) * random.unit_vector();
         },
         [](Random& random, double) { return random.log_uniform(1e-9, 1e9); }},
        {"far limit", 1000, [](Random& random, double) { return 0x1p60 * random.unit_vector(); },
         [](Random& random, double) { return random.uniform(0, 0x1p60); }},
        {"points", 1000, spread, [](Random&, double) { return 0.0; }},
        {"subnormal", 1000, [](Random& random, double) { return 1e-44 * random.in_cube(1); },
         [](Random&, double) { return 0.0; }},
        {"twins of two", 4096,
         [](Random&, double at) { return glm::dvec3(at < 0.5 ? -1 : 1, 0, 0); }, tiny},
    };
    return all;
}

template <typename T>
Boxes<T> boxes_of(const Cloud& cloud) {
    Random random(7);
    Boxes<T> boxes;
    for (std::size_t i = 0; i < cloud.count; ++i) {
        const double at = static_cast<double>(i) / static_cast<double>(cloud.count);
        const glm::dvec3 center = cloud.center(random, at);
        boxes.push_back(box_about<T>(center, cloud.half(random, at)));
        boxes.back().first = static_cast<typename Flat<T>::Index>(i);
    }
    return boxes;
}

template <typename T>
struct Built {
    Boxes<T> boxes;
    HugeVector<typename Flat<T>::BvhNode> nodes;
    typename Flat<T>::Index root = 0;
};

template <typename T>
Built<T> built(const Boxes<T>& boxes, int threads = 2) {
    Built<T> result;
    result.boxes = boxes;
    result.root = build_bvh<T>(result.boxes, threads, result.nodes);
    return result;
}

template <typename Node>
bool contains(const Node& outer, const Node& inner) {
    return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
           outer.high.x >= inner.high.x && outer.high.y >= inner.high.y &&
           outer.high.z >= inner.high.z;
}

/// Walks the hierarchy; every box must be in one leaf and inside all nodes above it.
template <typename T>
void expect_sound(const Built<T>& bvh, const Boxes<T>& boxes) {
    const auto& nodes = bvh.nodes;
    std::vector<int> seen(boxes.size(), 0);
    std::vector<std::size_t> stack{static_cast<std::size_t>(bvh.root)};
    std::size_t misplaced = 0, visited = 0;
    while (!stack.empty()) {
        const auto& node = nodes[stack.back()];
        stack.pop_back();
        visited += 1;
        if (node.count == 0) {
            const auto pair = static_cast<std::size_t>(node.first);
            ASSERT_EQ(pair % 2, 0u);
            ASSERT_LT(pair + 1, nodes.size());
            for (const std::size_t child : {pair, pair + 1}) {
                misplaced += contains(node, nodes[child]) ? 0 : 1;
                stack.push_back(child);
            }
            continue;
        }
        ASSERT_LE(static_cast<std::size_t>(node.count), most_in_leaf);
        for (auto i = node.first; i < node.first + node.count; ++i) {
            const auto index =
                static_cast<std::size_t>(bvh.boxes[static_cast<std::size_t>(i)].first);
            seen[index] += 1;
            misplaced += contains(node, boxes[index]) ? 0 : 1;
        }
    }
    EXPECT_EQ(misplaced, 0u);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
    EXPECT_EQ(visited + 1, nodes.size());  // all but node 0
}

template <typename T>
class BuildBvh : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BuildBvh, Precisions);

TYPED_TEST(BuildBvh, HoldsEveryBoxOnceAndIsBounded) {
    for (const Cloud& cloud : clouds()) {
        SCOPED_TRACE(cloud.name);
        const auto boxes = boxes_of<TypeParam>(cloud);
        const auto bvh = built<TypeParam>(boxes);
        EXPECT_EQ(bvh.root, 1);
        expect_sound<TypeParam>(bvh, boxes);
        const BvhShape shape = shape_of<TypeParam>(bvh.nodes, bvh.root);
        EXPECT_LE(shape.depth, max_bvh_depth);
        EXPECT_EQ(shape.nodes, 2 * shape.leaves - 1);
    }
}

TYPED_TEST(BuildBvh, DoesNotDependOnTheNumberOfThreads) {
    for (const Cloud& cloud : clouds()) {
        SCOPED_TRACE(cloud.name);
        const auto boxes = boxes_of<TypeParam>(cloud);
        const auto one = built<TypeParam>(boxes, 1);
        for (const int threads : {2, 7}) {
            const auto more = built<TypeParam>(boxes, threads);
            ASSERT_EQ(more.nodes.size(), one.nodes.size());
            EXPECT_EQ(std::memcmp(more.nodes.data(), one.nodes.data(),
                                  one.nodes.size() * sizeof(one.nodes[0])),
                      0);
            EXPECT_EQ(std::memcmp(more.boxes.data(), one.boxes.data(),
                                  one.boxes.size() * sizeof(one.boxes[0])),
                      0);
        }
    }
}

TYPED_TEST(BuildBvh, PutsSeveralHierarchiesIntoOneArray) {
    const auto small = boxes_of<TypeParam>(clouds()[2]);
    HugeVector<typename Flat<TypeParam>::BvhNode> nodes;
    for (int i = 0; i < 3; ++i) {
        Boxes<TypeParam> boxes = small;
        const auto root = build_bvh<TypeParam>(boxes, 1, nodes);
        EXPECT_EQ(root % 2, 1);
        const BvhShape shape = shape_of<TypeParam>(nodes, root);
        EXPECT_EQ(root + static_cast<decltype(root)>(shape.nodes),
                  static_cast<decltype(root)>(nodes.size()));
    }
}

TYPED_TEST(BuildBvh, BeatsHalvingOnASoup) {
    const auto boxes = boxes_of<TypeParam>(clouds()[3]);
    const auto bvh = built<TypeParam>(boxes);
    const BvhShape shape = shape_of<TypeParam>(bvh.nodes, bvh.root);
    EXPECT_LT(shape.sah_cost, 460);
    EXPECT_LT(shape.depth, 40);
}

/// Half the surface area.
template <typename Node>
double area_of(const Node& box) {
    const double x = double(box.high.x) - box.low.x, y = double(box.high.y) - box.low.y;
    const double z = double(box.high.z) - box.low.z;
    return x * (y + z) + y * z;
}

template <typename T>
double cost_of_side(std::span<const BvhBox<T>> boxes) {
    BvhBox<T> whole = boxes[0];
    for (const BvhBox<T>& box : boxes) {
        whole.low = {std::min(whole.low.x, box.low.x), std::min(whole.low.y, box.low.y),
                     std::min(whole.low.z, box.low.z)};
        whole.high = {std::max(whole.high.x, box.high.x), std::max(whole.high.y, box.high.y),
                      std::max(whole.high.z, box.high.z)};
    }
    return area_of(whole) * static_cast<double>(boxes.size());
}

/// The least cost of splitting the boxes, sorted by their centers along some axis.
template <typename T>
double least_cost(Boxes<T> boxes) {
    using Packed3 = typename Flat<T>::Packed3;
    double least = INFINITY;
    for (const auto axis : {&Packed3::x, &Packed3::y, &Packed3::z}) {
        std::sort(boxes.begin(), boxes.end(), [&](const auto& a, const auto& b) {
            return a.low.*axis + a.high.*axis < b.low.*axis + b.high.*axis;
        });
        const std::span<const BvhBox<T>> sorted = boxes;
        for (std::size_t left = 1; left < boxes.size(); ++left) {
            least = std::min(
                least, cost_of_side<T>(sorted.first(left)) + cost_of_side<T>(sorted.subspan(left)));
        }
    }
    return least;
}

/// The primitives in the leaves below a node.
template <typename Node>
std::size_t primitives_below(std::span<const Node> nodes, const Node& node) {
    if (node.count > 0) return static_cast<std::size_t>(node.count);
    const auto pair = static_cast<std::size_t>(node.first);
    return primitives_below(nodes, nodes[pair]) + primitives_below(nodes, nodes[pair + 1]);
}

/// Too many for a leaf, but so few that they are sorted.
TYPED_TEST(BuildBvh, SplitsFewBoxesWhereItCostsLeast) {
    using Node = typename Flat<TypeParam>::BvhNode;
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        Boxes<TypeParam> boxes;
        const int count = 9 + trial % 4;
        for (int i = 0; i < count; ++i) {
            boxes.push_back(box_about<TypeParam>(random.in_cube(1), random.uniform(0.01, 0.5)));
        }
        HugeVector<Node> nodes;
        Boxes<TypeParam> ordered = boxes;
        const auto root = static_cast<std::size_t>(build_bvh<TypeParam>(ordered, 1, nodes));
        double cost = 0;
        for (const std::size_t child : {0, 1}) {
            const Node& side = nodes[static_cast<std::size_t>(nodes[root].first) + child];
            cost += area_of(side) * static_cast<double>(primitives_below<Node>(nodes, side));
        }
        EXPECT_NEAR(cost, least_cost<TypeParam>(boxes), 1e-4 * cost) << trial;
    }
}

TYPED_TEST(BuildBvh, KeepsAMeshWithinAHundredBytesATriangle) {
    Scene scene;
    scene.materials.emplace_back();
    scene.camera.from = {0, 0, 5};
    add_mesh(scene, bumpy_mesh(5), 0);
    const FlatScene<TypeParam> flat = flatten<TypeParam>(scene);
    EXPECT_GT(flat.triangles.size(), 20000u);
    EXPECT_LT(flat.bytes(), 100 * flat.triangles.size() * sizeof(TypeParam) / sizeof(float));
}

}  // namespace
}  // namespace rt::this_file
