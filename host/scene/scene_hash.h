// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace rt {

/// A hash of what the scene shows: camera, light, materials and shapes; not its name or its
/// sampling (size, AA, bounces).
std::uint64_t scene_hash(const Scene& scene);

/// A hash of its spheres, cones, triangles and meshes alone.
std::uint64_t shapes_hash(const Scene& scene);

}  // namespace rt
