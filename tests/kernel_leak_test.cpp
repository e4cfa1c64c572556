// SPDX-License-Identifier: Apache-2.0
//
// Closed meshes on a device: no ray from inside escapes at an edge or a vertex, in strict
// arithmetic and where the compiler may contract. MIRRORBALL_TEST_RAYS sets how many rays are aimed
// at each mesh's edges, and how many at its vertices.
#include <algorithm>

#include "host/stress/stress_scenes.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

namespace rt::this_file {
namespace {

/// Most rays per launch, so that a large count takes no more memory.
constexpr std::size_t most_rays = 1 << 20;

struct ClosedShape {
    const char* name;
    Scene::Mesh mesh;
    glm::dvec3 eye;
};

const std::vector<ClosedShape>& shapes() {
    static const std::vector<ClosedShape> all{
        {"bumpy ball", bumpy_mesh(2), {0, 0, 0}},
        {"fan", fan_mesh(250), {0, 0, 0}},
        {"needles", needle_mesh(12, 4, 1e-6), {0, 0, 0}},
        {"tiny ball", placed(bumpy_mesh(1), 1e-6, {3, 2, 1}), {3, 2, 1}},
        {"far ball", placed(bumpy_mesh(1), 1, {148376, 1234, -223423}), {0, 0, 0}},
    };
    return all;
}

template <typename T>
FlatScene<T> flat_scene(const ClosedShape& shape) {
    Scene scene;
    scene.materials.emplace_back();
    scene.camera.from = shape.eye;
    scene.camera.at = shape.eye + glm::dvec3(0, 0, -1);
    add_mesh(scene, shape.mesh, 0);
    return flatten<T>(scene);
}

/// The center of the flat triangles' bounding box, and half its width.
template <typename T>
std::pair<glm::dvec3, double> middle_and_reach(const FlatScene<T>& flat) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const auto& triangle : flat.triangles) {
        for (const auto& corner : {triangle.p0, triangle.p1, triangle.p2}) {
            low = glm::min(low, in_double(corner));
            high = glm::max(high, in_double(corner));
        }
    }
    return {0.5 * (low + high), 0.5 * (high.x - low.x)};
}

/// How many rays that start inside escape at an edge (or at a vertex).
template <typename T>
std::size_t leaks(const FlatScene<T>& flat, bool at_vertices, std::size_t rays) {
    const auto [middle, reach] = middle_and_reach(flat);
    Random random(6);
    const auto ray_at_rim = [&] {
        const auto index = random.index(static_cast<int>(flat.triangles.size()));
        const auto& triangle = flat.triangles[static_cast<std::size_t>(index)];
        const glm::dvec3 corners[] = {in_double(triangle.p0), in_double(triangle.p1),
                                      in_double(triangle.p2)};
        const int first = random.index(3);
        const double share = at_vertices ? 0 : random.uniform(0, 1);
        const glm::dvec3 target =
            corners[first] + share * (corners[(first + 1) % 3] - corners[first]);
        const auto origin = in_double(pack<T>(middle + 0.15 * reach * random.in_cube(1)));
        return make_ray<T>(origin, target - origin);
    };
    std::size_t out = 0;
    for (std::size_t done = 0; done < rays; done += most_rays) {
        const auto some = many(std::min(rays - done, most_rays), ray_at_rim);
        const auto found = run<T, typename Flat<T>::Index>("any_hit", some.size(), flat, some);
        out += static_cast<std::size_t>(std::count(found.begin(), found.end(), 0));
    }
    return out;
}

template <typename T>
void expect_no_leaks() {
    for (const ClosedShape& shape : shapes()) {
        const FlatScene<T> flat = flat_scene<T>(shape);
        ASSERT_FALSE(flat.nodes.empty());
        EXPECT_EQ(leaks(flat, false, ray_count(250000)), 0u) << "edges of the " << shape.name;
        EXPECT_EQ(leaks(flat, true, ray_count(250000)), 0u) << "vertices of the " << shape.name;
    }
}

KERNEL_SUITE(ClosedMesh);
TYPED_TEST(ClosedMesh, NeverLeaks) { expect_no_leaks<TypeParam>(); }
TYPED_TEST(ClosedMesh, NeverLeaksInFastArithmetic) {
    const FastMath fast;
    expect_no_leaks<TypeParam>();
}

// The test detects a hole in a mesh.
TYPED_TEST(ClosedMesh, WithATriangleMissingLeaks) {
    ClosedShape open = shapes()[0];
    open.mesh.faces.pop_back();
    EXPECT_GT(leaks(flat_scene<TypeParam>(open), false, 20000), 0u);
}

}  // namespace
}  // namespace rt::this_file
