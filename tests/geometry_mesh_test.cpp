// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "host/scene/geometry.h"
#include "host/scene/mesh.h"

namespace rt::this_file {
namespace {

using Positions = std::vector<glm::dvec3>;
using Faces = std::vector<Scene::Mesh::Face>;

double area_of(const Positions& corners, const Scene::Mesh::Face& face) {
    const auto [a, b, c] = face;
    return glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z / 2;
}

/// The triangles' total area seen along z; each area must be positive.
double total_area(const Positions& corners, const Faces& triangles) {
    double total = 0;
    for (const auto& face : triangles) {
        EXPECT_GT(area_of(corners, face), 0);
        total += area_of(corners, face);
    }
    return total;
}

double shoelace(const Positions& corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sum += glm::cross(corners[i], corners[(i + 1) % corners.size()]).z / 2;
    }
    return sum;
}

struct Split {
    Faces faces;
    std::string wrong;  ///< "": nothing
};

/// The triangles of a face in a file of so many bytes, and what is wrong with it.
Split split(const Positions& corners, std::size_t file_bytes = 0) {
    std::vector<std::uint32_t> face(corners.size());
    std::iota(face.begin(), face.end(), 0u);
    Split result;
    const PolygonBlemish* const blemish =
        append_face(face, {}, corners, file_bytes, result.faces, nullptr);
    if (blemish) result.wrong = blemish->message;
    return result;
}

Faces triangulate(const Positions& corners) { return split(corners).faces; }

constexpr const char* no_area = "zero-area polygon; remove it";
constexpr const char* not_simple =
    "the polygon is self-intersecting or too complex and may look wrong; split it";

/// Triangulates a polygon in z = 0 exactly: all parts face up and total `area`.
Faces expect_split(const Positions& corners, double area) {
    const auto [faces, wrong] = split(corners);
    EXPECT_EQ(wrong, "");
    EXPECT_NEAR(total_area(corners, faces), area, 1e-12 * std::abs(area));
    return faces;
}

Positions ring_of(int corners, double inner, double outer) {
    Positions ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double radius = i % 2 == 0 ? outer : inner;
        ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return ring;
}

TEST(Orientation, IsExactWhereRoundingWouldNotBe) {
    const double ulp = std::ldexp(1.0, -53);
    EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
    EXPECT_EQ(orientation({0.5, 0.5 + ulp}, {12, 12}, {24, 24}), 1);
    EXPECT_EQ(orientation({0.5 + ulp, 0.5}, {12, 12}, {24, 24}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0.5, 1e-300}), 1);
}

TEST(MeshFaces, ConvexPolygonIsAFan) {
    const Positions corners = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    EXPECT_EQ(triangulate(corners), (Faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(MeshFaces, EveryStartAndEveryAxisGiveTheSameArea) {
    const Positions shape = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0},
                             {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};  // a U of area 8
    for (std::size_t start = 0; start < shape.size(); ++start) {
        Positions turned = shape;
        std::rotate(turned.begin(), turned.begin() + static_cast<long>(start), turned.end());
        const Faces triangles = triangulate(turned);
        EXPECT_EQ(triangles.size(), 6u);
        EXPECT_DOUBLE_EQ(total_area(turned, triangles), 8.0);
        for (int axis = 1; axis < 3; ++axis) {
            Positions elsewhere;
            for (const glm::dvec3& p : turned) {
                elsewhere.push_back(axis == 1 ? glm::dvec3(p.z, p.x, p.y)
                                              : glm::dvec3(p.y, p.z, p.x));
            }
            EXPECT_EQ(triangulate(elsewhere), triangles);
        }
    }
}

TEST(MeshFaces, CombsAndSpiralsKeepTheirArea) {
    Positions comb, spiral;
    for (int i = 0; i < 100; ++i) comb.emplace_back(i, i % 2 == 0 ? 0 : 0.5, 0);
    for (int i = 99; i >= 0; --i) comb.emplace_back(i, i % 2 == 0 ? 0.6 : 5, 0);
    for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < 300; ++k) {
            const int i = side == 0 ? k : 299 - k;
            const double angle = 0.1 * i, radius = 1 + 0.1 * angle + (side == 0 ? 0.3 : 0);
            spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
    }
    for (const Positions& shape : {comb, spiral}) {
        EXPECT_EQ(expect_split(shape, shoelace(shape)).size(), shape.size() - 2);
    }
}

TEST(MeshFaces, StarsOfAnySize) {
    for (const int corners : {6, 10, 144, 1000}) {
        const auto ring = ring_of(corners, 0.3, 1);
        const double area = 0.5 * 0.3 * corners * std::sin(2 * std::numbers::pi / corners);
        EXPECT_EQ(expect_split(ring, area).size(), ring.size() - 2);
    }
}

TEST(MeshFaces, ManyCornersOnAnEdge) {
    Positions corners{{0, 5, 0}};
    for (int i = 0; i <= 5000; ++i) corners.emplace_back(i, 0, 0);
    EXPECT_EQ(expect_split(corners, 5000 * 5 / 2.0).size(), 5000u);
}

TEST(MeshFaces, HoleJoinedByASlit) {
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

TEST(MeshFaces, CornersThatTouchAnEdge) {
    expect_split({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}, 8);
}

TEST(MeshFaces, RepeatedCornersAndSpikes) {
    expect_split({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1);
    expect_split({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);
}

TEST(MeshFaces, AnyScaleAndPlace) {
    for (const double scale : {1e-30, 1e-12, 1.0, 1e12, 1e29}) {
        Positions ring = ring_of(20, 0.5, 1);
        for (glm::dvec3& corner : ring) corner *= scale;
        const double area = 5 * std::sin(2 * std::numbers::pi / 20) * scale * scale;
        expect_split(ring, area);
    }
}

TEST(MeshFaces, BackOfAPolygonStaysItsBack) {
    Positions ring = ring_of(12, 0.5, 1);
    std::reverse(ring.begin(), ring.end());
    for (const auto& face : triangulate(ring)) EXPECT_LT(area_of(ring, face), 0);
}

/// Corners coincide, or lie on a line, in the projection only.
TEST(MeshFaces, WhatIsNotFlatLosesNothing) {
    for (const Positions& corners :
         {Positions{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 1}},
          Positions{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 1}, {0, 2, 0}},
          Positions{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {2, 2, 1}, {2, 2, 0}, {0, 2, 0}},
          Positions{{0, 0, 0}, {1, 0, 3}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 2, 1}},
          Positions{{0, 0, 0}, {2, 0, 0}, {4, 0, 1}, {2, 0, 0.5}, {2, 2, 0}, {0, 2, 0}}}) {
        const auto [faces, wrong] = split(corners);
        EXPECT_EQ(faces.size(), corners.size() - 2);
        EXPECT_EQ(wrong, "");
    }
}

TEST(MeshFaces, FacesWithoutAreaAreLeftOutWithANote) {
    const Positions line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
    for (const Positions& corners : {line, Positions(5, glm::dvec3(7, 8, 9))}) {
        const auto [faces, wrong] = split(corners);
        EXPECT_TRUE(faces.empty());
        EXPECT_EQ(wrong, no_area);
    }
}

TEST(MeshFaces, FacesThatCrossThemselvesAreFansWithANote) {
    const Positions bow = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}};
    const Split of_bow = split(bow);
    EXPECT_EQ(of_bow.faces, (Faces{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(of_bow.wrong, not_simple);
    Positions pentagram;
    for (int i = 0; i < 5; ++i) {
        pentagram.emplace_back(std::cos(i * 2.513274), std::sin(i * 2.513274), 0);
    }
    const Split of_pentagram = split(pentagram);
    EXPECT_EQ(of_pentagram.faces, (Faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(of_pentagram.wrong, not_simple);
}

TEST(MeshFaces, IntricateFacesAreFansInLargeFiles) {
    Positions comb = {{-1, 0, 0}};
    for (int tooth = 0; tooth < 3300; ++tooth) {
        comb.emplace_back(0, 2 * tooth, 0);
        comb.emplace_back(1e6, 2 * tooth + 0.5, 0);
        comb.emplace_back(0, 2 * tooth + 1, 0);
    }
    comb.emplace_back(-1, 2 * 3300, 0);
    const std::size_t alone = 30 * comb.size();  // bytes of a file that holds nothing else
    EXPECT_NEAR(total_area(comb, split(comb, alone).faces), shoelace(comb), 1);
    constexpr std::size_t large = std::size_t{1} << 31;
    const auto [faces, wrong] = split(comb, large);
    EXPECT_EQ(faces.size(), comb.size() - 2);
    EXPECT_EQ(wrong, not_simple);
    const Positions dart = {{2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}, {0, 0, 0}};
    EXPECT_DOUBLE_EQ(total_area(dart, split(dart, large).faces), 1.0);
}

}  // namespace
}  // namespace rt::this_file
