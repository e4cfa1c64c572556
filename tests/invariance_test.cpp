// SPDX-License-Identifier: Apache-2.0
//
// The renderer's frame (host/flatten/view_frame.h): a scene moved with its camera, or scaled by a
// power of two, gives the same bits; and the arithmetic traps that would break it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render_helpers.h"

namespace rt::test {
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
    Scene scene = load_scene("cornell-box");
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

// GCC 12 drops the rounding of two neighbouring doubles to float in its SLP vectoriser, unless told
// not to vectorise so (CMakeLists.txt): a double renderer would be fed unrounded numbers.
__attribute__((noinline)) void round_pair(const double* in, double* out) {
    const float x = static_cast<float>(in[0]), y = static_cast<float>(in[1]);
    out[0] = x;
    out[1] = y;
}

/// A number that the compiler cannot reckon with beforehand.
template <typename T>
T hidden(T number) {
    volatile T copy = number;
    return copy;
}

TEST(Compiler, RoundsNeighbouringDoublesToFloat) {
    const double in[2] = {hidden(0.1), hidden(0.3)};
    double out[2] = {0, 0};
    round_pair(in, out);
    EXPECT_EQ(out[0], 0.100000001490116119384765625);
    EXPECT_EQ(out[1], 0.300000011920928955078125);
}

// a * b + c must not become one fma behind our back, or the twin leaves the strict kernels.
__attribute__((noinline)) float multiply_add(float a, float b, float c) { return a * b + c; }

TEST(Compiler, DoesNotContract) {
    const float a = 1.0f + 0x1p-12f;
    EXPECT_EQ(multiply_add(hidden(a), hidden(a), hidden(-1.0f - 0x1p-11f)), 0.0f);
}

}  // namespace
}  // namespace rt::test
