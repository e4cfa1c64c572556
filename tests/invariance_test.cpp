// SPDX-License-Identifier: Apache-2.0
//
// The renderer's frame (host/flatten/view_frame.h): a scene translated with its camera, or scaled
// by a power of two, gives the same bits.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// The scene with every position p replaced by scale * p + shift, and lengths by scale * length.
Scene moved(Scene scene, double scale, const glm::dvec3& shift) {
    const auto move = [&](glm::dvec3& p) { p = p * scale + shift; };
    move(scene.camera.from);
    move(scene.camera.at);
    for (auto& light : scene.lights) move(light.position);
    for (auto& sphere : scene.spheres) {
        move(sphere.center);
        sphere.radius *= scale;
    }
    for (auto& triangle : scene.triangles) {
        for (auto& vertex : triangle.vertices) move(vertex);
    }
    return scene;
}

/// The paper's scene at 120 x 120, its numbers rounded to multiples of 2^-20, so that shifting by
/// integers up to 2^30 is exact.
Scene small_paper_scene() {
    Scene scene = load_named_scene("cornell-box");
    set_image_size(scene, 120, 120);
    const auto round = [](glm::dvec3& p) {
        for (int i = 0; i < 3; ++i) p[i] = std::ldexp(std::nearbyint(std::ldexp(p[i], 20)), -20);
    };
    for (auto& light : scene.lights) round(light.position);
    for (auto& sphere : scene.spheres) round(sphere.center);
    for (auto& triangle : scene.triangles) {
        for (auto& vertex : triangle.vertices) round(vertex);
    }
    return scene;
}

TEST(MovedScene, ScaledByAPowerOfTwoGivesTheSameBits) {
    const Scene scene = small_paper_scene();
    const std::uint64_t hash = hash_of(render_on_threads<float>(scene));
    for (const int k : {-40, -13, -1, 1, 20, 40}) {
        const Scene scaled = moved(scene, std::ldexp(1.0, k), {0, 0, 0});
        EXPECT_EQ(hash_of(render_on_threads<float>(scaled)), hash) << "2^" << k;
        EXPECT_EQ(hash_of(render_on_device<float>(scaled)), hash) << "2^" << k;
    }
}

TEST(MovedScene, ShiftedByIntegersGivesTheSameBits) {
    const Scene scene = small_paper_scene();
    const std::uint64_t hash = hash_of(render_on_threads<float>(scene));
    for (const double shift : {1e4, 1e6, 1e9}) {
        const Scene shifted = moved(scene, 1, shift * glm::dvec3(1, -1, 0.5));
        EXPECT_EQ(hash_of(render_on_threads<float>(shifted)), hash) << shift;
    }
}

TEST(MovedScene, ScaledByAPowerOfTenDiffersOnlyAtEdges) {
    const Scene scene = small_paper_scene();
    const Film<double> reference = render_on_threads<double>(scene);
    for (const int k : {-30, -6, 3, 29}) {
        const Scene scaled = moved(scene, std::pow(10.0, k), {0, 0, 0});
        const ImageError error = film_error(render_on_threads<float>(scaled), reference);
        EXPECT_EQ(error.non_finite, 0u);
        EXPECT_LE(error.over_1, 4u) << "10^" << k;
    }
}

}  // namespace
}  // namespace rt::test::this_file
