// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace rt {

/// A fingerprint of what the scene shows: camera, light, materials and shapes; not its name, nor
/// how finely it is sampled (size, AA, bounces).
std::uint64_t scene_hash(const Scene& scene);

}  // namespace rt
