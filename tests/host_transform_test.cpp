// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "host/scene/geometry.h"
#include "host/scene/mesh.h"

namespace rt::this_file {
namespace {

using Faces = std::vector<Scene::Mesh::Face>;

constexpr std::uint32_t none = Scene::Mesh::no_normal;

void expect_near(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::length(a - b), 1e-14) << a.x << " " << a.y << " " << a.z;
}

glm::dvec3 apply(const Affine& affine, glm::dvec3 p) {
    return affine.linear * p + affine.translation;
}

TEST(MakeAffine, StepsComeInTheDocumentedOrder) {
    // (1, 2, 3) scaled is (2, 6, 12); about x by 90 it is (2, -12, 6); about y by 90, (6, -12, -2);
    // about z by 90, (12, 6, -2).
    const Affine affine = make_affine({2, 3, 4}, {90, 90, 90}, {100, 200, 300});
    EXPECT_EQ(apply(affine, {1, 2, 3}), glm::dvec3(112, 206, 298));
    const double s = std::sqrt(0.5);
    expect_near(apply(make_affine({1, 1, 1}, {0, 0, 45}, {0, 0, 0}), {1, 0, 0}), {s, s, 0});
    expect_near(apply(make_affine({1, 1, 1}, {0, 45, 0}, {0, 0, 0}), {1, 0, 0}), {s, 0, -s});
    expect_near(apply(make_affine({1, 1, 1}, {45, 0, 0}, {0, 0, 0}), {0, 1, 0}), {0, s, s});
    EXPECT_EQ(apply(make_affine({1, 1, 1}, {0, 0, -450}, {0, 0, 0}), {1, 0, 0}),
              glm::dvec3(0, -1, 0));
}

TEST(NormalMatrix, SingularOnesHaveNone) {
    EXPECT_FALSE(normal_matrix(glm::dmat3(0)));
    EXPECT_FALSE(normal_matrix(glm::dmat3(1, 2, 3, 4, 5, 6, 7, 8, 9)));
    EXPECT_FALSE(normal_matrix(glm::dmat3(1, 0, 0, 0, 1, 0, 1, 1, 0)));
    EXPECT_TRUE(normal_matrix(glm::dmat3(1e-9, 0, 0, 0, 1e20, 0, 0, 0, -1)));
}

/// A triangle in the plane x + y = 1, with its normal.
Scene::Mesh slanted() {
    Scene::Mesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {1, 0, 1}};
    mesh.normals = {{5, 5, 0}};
    mesh.faces = {{0, 1, 2}};
    mesh.face_normals = {{0, 0, 0}};
    mesh.face_materials = {0};
    return mesh;
}

glm::dvec3 normal_of(const Scene::Mesh& mesh, std::size_t face) {
    const auto [a, b, c] = mesh.faces[face];
    return glm::normalize(
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

/// Finishes the mesh; returns the notes.
std::vector<std::string> finish(Scene::Mesh& mesh, const Affine& transform) {
    std::vector<std::string> notes;
    finish_mesh(mesh, transform, "m.obj", notes);
    return notes;
}

TEST(FinishMesh, NormalsStayAtRightAnglesToTheirFaces) {
    for (const glm::dvec3 scale : {glm::dvec3(1, 1, 1), glm::dvec3(2, 1, 1), glm::dvec3(3, 5, 7),
                                   glm::dvec3(1e-20, 1e-20, 1e-20), glm::dvec3(-1, 1, 1),
                                   glm::dvec3(-2, -3, -4), glm::dvec3(-1, -1, 5)}) {
        Scene::Mesh mesh = slanted();
        finish(mesh, make_affine(scale, {10, 20, 30}, {0, 0, 0}));
        expect_near(mesh.normals[0], normal_of(mesh, 0));
        EXPECT_NEAR(glm::length(mesh.normals[0]), 1, 1e-15);
    }
    Scene::Mesh mesh = slanted();
    finish(mesh, make_affine({2, 1, 1}, {0, 0, 0}, {0, 0, 0}));
    expect_near(mesh.normals[0], glm::dvec3(1, 2, 0) / std::sqrt(5.0));
}

TEST(FinishMesh, MirroringTurnsFacesRound) {
    Scene::Mesh mesh = slanted();
    mesh.normals = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
    mesh.face_normals = {{0, 1, 2}};
    finish(mesh, make_affine({1, 1, -1}, {0, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(mesh.faces, (Faces{{0, 2, 1}}));
    EXPECT_EQ(mesh.face_normals, (Faces{{0, 2, 1}}));
}

TEST(FinishMesh, TrianglesWithoutAreaGo) {
    Scene::Mesh mesh = slanted();
    mesh.faces = {{0, 0, 1}, {0, 1, 2}, {2, 2, 2}};
    mesh.face_normals = mesh.faces;
    mesh.normals = {{1, 1, 0}, {0, 0, 0}, {0, 0, 1}};
    mesh.face_materials = {4, 5, 6};
    EXPECT_EQ(finish(mesh, {}),
              (std::vector<std::string>{"m.obj: ignored 2 zero-area triangles",
                                        "m.obj: 1 face is flat, as a vertex normal has length 0"}));
    EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}}));
    EXPECT_EQ(mesh.face_normals, (Faces{{none, none, none}}));
    EXPECT_EQ(mesh.face_materials, std::vector<int>{5});
}

}  // namespace
}  // namespace rt::this_file
