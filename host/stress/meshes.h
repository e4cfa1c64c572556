// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

/// A mesh with shared vertices, counterclockwise from outside.
struct StressMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<int, 3>> faces;
};

/// An icosahedron (20 faces) on the unit sphere, each face split in four `times` times.
StressMesh ball_mesh(int times);

/// The same with its vertices moved in and out by up to a fifth, at random.
StressMesh bumpy_mesh(int times);

/// Two hubs joined to the same rim of `spokes` points: closed, thin at the hubs.
StressMesh fan_mesh(int spokes);

/// A fan whose rim points come in clusters `gap` wide: needles of length 1 among wide triangles.
StressMesh needle_mesh(int clusters, int needles, double gap);

/// A prism along z over a triangle: two sides of length 1 that meet at this angle.
StressMesh wedge_mesh(double degrees);

/// A box from -1 to 1.
StressMesh box_mesh();

/// Scaled, then moved.
StressMesh placed(StressMesh mesh, double scale, glm::dvec3 to);

void add_mesh(Scene& scene, const StressMesh& mesh, int material);

}  // namespace rt
