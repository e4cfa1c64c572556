// SPDX-License-Identifier: Apache-2.0
//
// What the compiler gets wrong unless CMakeLists.txt tells it not to.
#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>

namespace {

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
