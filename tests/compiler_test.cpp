// SPDX-License-Identifier: Apache-2.0
//
// What the compiler would do to our arithmetic without the flags in CMakeLists.txt.
#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>

namespace {

// GCC 12's SLP vectorizer drops the rounding of two neighboring doubles to float, unless it is
// turned off (CMakeLists.txt): a double renderer would be fed unrounded numbers.
__attribute__((noinline)) void round_pair(const double* in, double* out) {
    const float x = static_cast<float>(in[0]), y = static_cast<float>(in[1]);
    out[0] = x;
    out[1] = y;
}

/// A number hidden from constant folding.
template <typename T>
T hidden(T number) {
    volatile T copy = number;
    return copy;
}

TEST(Compiler, RoundsNeighboringDoublesToFloat) {
    const double in[2] = {hidden(0.1), hidden(0.3)};
    double out[2] = {0, 0};
    round_pair(in, out);
    EXPECT_EQ(out[0], 0.100000001490116119384765625);
    EXPECT_EQ(out[1], 0.300000011920928955078125);
}

// a * b + c must not silently become one fma, or host and kernels diverge.
__attribute__((noinline)) float multiply_add(float a, float b, float c) { return a * b + c; }

TEST(Compiler, DoesNotContract) {
    const float a = 1.0f + 0x1p-12f;
    EXPECT_EQ(multiply_add(hidden(a), hidden(a), hidden(-1.0f - 0x1p-11f)), 0.0f);
}

struct Corners {
    long eye[3], corner[3][3];
};

/// GCC 12 -O2, tuned for CPUs with AVX-512, loses eye.y here without -fno-ivopts.
[[gnu::noinline]] std::array<float, 12> copied_by_index(const Corners& from) {
    glm::dvec3 eye, corner[3];
    for (int k = 0; k < 3; ++k) {
        eye[k] = double(from.eye[k]);
        for (int i = 0; i < 3; ++i) corner[i][k] = double(from.corner[i][k]);
    }
    std::array<float, 12> copy{float(eye.x), float(eye.y), float(eye.z)};
    for (int i = 0; i < 3; ++i) {
        copy[3 * i + 3] = float(corner[i].x);
        copy[3 * i + 4] = float(corner[i].y);
        copy[3 * i + 5] = float(corner[i].z);
    }
    return copy;
}

TEST(Compiler, KeepsStoresThroughGlmsIndex) {
    const Corners from{{1, 2, 3}, {{4, 5, 6}, {7, 8, 9}, {10, 11, 12}}};
    EXPECT_EQ(copied_by_index(from),
              (std::array<float, 12>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

}  // namespace
