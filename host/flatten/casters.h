// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "host/flatten/triangle_list.h"
#include "host/scene/scene.h"

namespace rt {

/// The triangles that may cast a shadow from a point light, ascending. Omits a triangle if its
/// plane has all geometry, the origins of eye rays (`eyes`), and the light on one closed side: the
/// walls of a room lit from within. When in doubt, keeps it: if the light is near the plane, or if
/// another surface meets the plane so that the offset of a shadow ray's origin from it may cross
/// the plane. Takes quadratic time in the number of triangles.
std::vector<std::size_t> shadow_casters(const Scene& scene, const TriangleList& triangles,
                                        std::span<const glm::dvec3> eyes, const glm::dvec3& light);

}  // namespace rt
