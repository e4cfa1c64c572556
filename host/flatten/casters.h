// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "host/flatten/triangle_list.h"
#include "host/scene/scene.h"

namespace rt {

/// The triangles that may cast a shadow in the light of a point, ascending. Left out is a triangle
/// whose plane has all geometry, where eye rays start (`eyes`), and the light on one closed side:
/// the walls of a room lit from within. In doubt a triangle is kept: where the light lies near the
/// plane, or where another triangle meets the plane so that a shadow ray's first step, off that
/// triangle, leads through it. Takes time in the number of triangles squared.
std::vector<std::size_t> shadow_casters(const Scene& scene, const TriangleList& triangles,
                                        std::span<const glm::dvec3> eyes, const glm::dvec3& light);

}  // namespace rt
