// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace rt {

/// On which side of the line from a to b the point c lies: 1 on its left, -1 on its right, 0 on
/// it. Exact for coordinates whose products neither overflow nor underflow (Shewchuk, Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
int orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c);

}  // namespace rt
