// SPDX-License-Identifier: Apache-2.0
#include "host/stress/meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

StressMesh icosahedron() {
    const double g = std::numbers::phi;
    StressMesh mesh{
        {{-1, g, 0},
         {1, g, 0},
         {-1, -g, 0},
         {1, -g, 0},
         {0, -1, g},
         {0, 1, g},
         {0, -1, -g},
         {0, 1, -g},
         {g, 0, -1},
         {g, 0, 1},
         {-g, 0, -1},
         {-g, 0, 1}},
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (auto& vertex : mesh.vertices) vertex = glm::normalize(vertex);
    return mesh;
}

StressMesh cut_in_four(StressMesh mesh) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [entry, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
        if (is_new) {
            mesh.vertices.push_back(glm::normalize(mesh.vertices[static_cast<std::size_t>(a)] +
                                                   mesh.vertices[static_cast<std::size_t>(b)]));
        }
        return entry->second;
    };
    std::vector<std::array<int, 3>> faces;
    for (const auto& [a, b, c] : mesh.faces) {
        const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        faces.insert(faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
    return mesh;
}

/// Hubs above and below a rim at these angles.
StressMesh hubs_and_rim(const std::vector<double>& angles) {
    StressMesh mesh{{{0, 1, 0}, {0, -1, 0}}, {}};
    for (const double angle : angles) {
        mesh.vertices.push_back({std::cos(angle), 0, -std::sin(angle)});
    }
    const int count = static_cast<int>(angles.size());
    for (int i = 0; i < count; ++i) {
        const int a = 2 + i, b = 2 + (i + 1) % count;
        mesh.faces.push_back({0, a, b});
        mesh.faces.push_back({1, b, a});
    }
    return mesh;
}

}  // namespace

StressMesh ball_mesh(int times) {
    StressMesh mesh = icosahedron();
    for (int i = 0; i < times; ++i) mesh = cut_in_four(std::move(mesh));
    return mesh;
}

StressMesh bumpy_mesh(int times) {
    StressMesh mesh = ball_mesh(times);
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> radius(0.8, 1.2);
    for (auto& vertex : mesh.vertices) vertex *= radius(engine);
    return mesh;
}

StressMesh fan_mesh(int spokes) {
    std::vector<double> angles;
    for (int i = 0; i < spokes; ++i) angles.push_back(2 * std::numbers::pi * i / spokes);
    return hubs_and_rim(angles);
}

StressMesh needle_mesh(int clusters, int needles, double gap) {
    std::vector<double> angles;
    for (int i = 0; i < clusters; ++i) {
        for (int j = 0; j <= needles; ++j) {
            angles.push_back(2 * std::numbers::pi * i / clusters + gap * j);
        }
    }
    return hubs_and_rim(angles);
}

StressMesh wedge_mesh(double degrees) {
    const double half = degrees * std::numbers::pi / 360, x = std::cos(half), y = std::sin(half);
    return {
        {{0, 0, -1}, {x, -y, -1}, {x, y, -1}, {0, 0, 1}, {x, -y, 1}, {x, y, 1}},
        {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

StressMesh box_mesh() {
    StressMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back({(i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1});
    }
    for (const auto& [a, b, c, d] :
         {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
          std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
        mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
    }
    return mesh;
}

StressMesh placed(StressMesh mesh, double scale, glm::dvec3 to) {
    for (auto& vertex : mesh.vertices) vertex = scale * vertex + to;
    return mesh;
}

void add_mesh(Scene& scene, const StressMesh& mesh, int material) {
    const auto vertex = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    for (const auto& [a, b, c] : mesh.faces) {
        add_triangle(scene, vertex(a), vertex(b), vertex(c), material);
    }
}

}  // namespace rt
