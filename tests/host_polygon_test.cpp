// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "host/scene/geometry.h"
#include "host/scene/polygon.h"

namespace rt {
namespace {

using Face = std::array<std::uint32_t, 3>;

TEST(Orientation, IsExactWhereRoundingWouldNotBe) {
    const double ulp = std::ldexp(1.0, -53);
    EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
    EXPECT_EQ(orientation({0.5, 0.5 + ulp}, {12, 12}, {24, 24}), 1);
    EXPECT_EQ(orientation({0.5 + ulp, 0.5}, {12, 12}, {24, 24}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0.5, 1e-300}), 1);
}

double area_of(const std::vector<glm::dvec3>& corners, const Face& face) {
    const auto [a, b, c] = face;
    return glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z / 2;
}

/// Triangulates a polygon in z = 0, which must succeed: all parts face up and total `area`.
std::vector<Face> expect_split(const std::vector<glm::dvec3>& corners, double area) {
    std::int64_t work = max_polygon_work;
    std::vector<Face> faces;
    EXPECT_TRUE(triangulate(corners, work, faces));
    double sum = 0;
    for (const Face& face : faces) {
        EXPECT_GT(area_of(corners, face), 0);
        sum += area_of(corners, face);
    }
    EXPECT_NEAR(sum, area, 1e-12 * std::abs(area));
    return faces;
}

std::vector<glm::dvec3> ring_of(int corners, double inner, double outer) {
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double radius = i % 2 == 0 ? outer : inner;
        ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return ring;
}

TEST(Triangulate, ConvexPolygon) {
    const auto ring = ring_of(100, 1, 1);
    EXPECT_EQ(expect_split(ring, 50 * std::sin(2 * std::numbers::pi / 100)).size(), 98u);
}

TEST(Triangulate, StarsOfAnySize) {
    for (const int corners : {6, 10, 144, 1000}) {
        const auto ring = ring_of(corners, 0.3, 1);
        const double area = 0.5 * 0.3 * corners * std::sin(2 * std::numbers::pi / corners);
        EXPECT_EQ(expect_split(ring, area).size(), ring.size() - 2);
    }
}

TEST(Triangulate, CornersOnAnEdgeBecomeCornersOfTriangles) {
    const auto faces = expect_split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 4);
    EXPECT_EQ(faces.size(), 3u);
}

TEST(Triangulate, ManyCornersOnAnEdge) {
    std::vector<glm::dvec3> corners{{0, 5, 0}};
    for (int i = 0; i <= 5000; ++i) corners.emplace_back(i, 0, 0);
    EXPECT_EQ(expect_split(corners, 5000 * 5 / 2.0).size(), 5000u);
}

TEST(Triangulate, HoleJoinedByASlit) {
    expect_split({{0, 0, 0},
                  {4, 0, 0},
                  {4, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0}},
                 12);
}

TEST(Triangulate, CornersThatTouchAnEdge) {
    expect_split({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}, 8);
}

TEST(Triangulate, RepeatedCornersAndSpikes) {
    expect_split({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1);
    expect_split({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);
}

TEST(Triangulate, AnyScaleAndPlace) {
    for (const double scale : {1e-30, 1e-12, 1.0, 1e12, 1e29}) {
        std::vector<glm::dvec3> ring = ring_of(20, 0.5, 1);
        for (glm::dvec3& corner : ring) corner *= scale;
        const double area = 5 * std::sin(2 * std::numbers::pi / 20) * scale * scale;
        expect_split(ring, area);
    }
}

TEST(Triangulate, BackOfAPolygonStaysItsBack) {
    std::vector<glm::dvec3> ring = ring_of(12, 0.5, 1);
    std::reverse(ring.begin(), ring.end());
    std::int64_t work = max_polygon_work;
    std::vector<Face> faces;
    ASSERT_TRUE(triangulate(ring, work, faces));
    for (const Face& face : faces) EXPECT_LT(area_of(ring, face), 0);
}

/// Corners coincide, or lie on a line, in the projection only.
TEST(Triangulate, WhatIsNotFlatLosesNothing) {
    using Corners = std::vector<glm::dvec3>;
    for (const Corners& corners :
         {Corners{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 1}},
          Corners{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 1}, {0, 2, 0}},
          Corners{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {2, 2, 1}, {2, 2, 0}, {0, 2, 0}},
          Corners{{0, 0, 0}, {1, 0, 3}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 2, 1}},
          Corners{{0, 0, 0}, {2, 0, 0}, {4, 0, 1}, {2, 0, 0.5}, {2, 2, 0}, {0, 2, 0}}}) {
        std::int64_t work = max_polygon_work;
        std::vector<Face> faces;
        EXPECT_TRUE(triangulate(corners, work, faces));
        EXPECT_EQ(faces.size(), corners.size() - 2);
    }
}

TEST(Triangulate, TellsWhatIsNotExact) {
    std::vector<Face> faces;
    const auto is_exact = [&](const std::vector<glm::dvec3>& corners, std::int64_t work) {
        return triangulate(corners, work, faces);
    };
    EXPECT_FALSE(is_exact({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, max_polygon_work));
    EXPECT_FALSE(is_exact(ring_of(1000, 0.3, 1), 1000));
    EXPECT_TRUE(is_exact({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}}, max_polygon_work));
    EXPECT_TRUE(faces.empty());
}

}  // namespace
}  // namespace rt
