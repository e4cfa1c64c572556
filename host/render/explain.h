// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "kernels/native/path_event.h"

namespace rt {

/// A pixel, and all events of its paths, in the order in which they happened
/// (kernels/native/explain.cl).
struct ExplainedPixel {
    glm::dvec3 color{0};
    std::vector<PathEvent> events;
};

/// Renders one pixel in double, one ray at a time; x and y count from the top left. The same bits
/// as in a picture.
ExplainedPixel explain_pixel(const FlatScene<double>& scene, int x, int y);

}  // namespace rt
