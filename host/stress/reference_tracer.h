// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "host/scene/scene.h"
#include "host/stress/stress_case.h"

namespace rt {

/// Renders a scene according to docs/scene-format.md, by textbook formulas in wide arithmetic on
/// the author's own coordinates: nothing is recentered, scaled or shared with the renderers.
/// Surfaces closer together than 1e-12 of the distance count as one, the first in the scene.
class ReferenceTracer {
   public:
    virtual ~ReferenceTracer() = default;

    /// Linear light, not clamped, at the point (x, y) of the picture, in pixels from its top left
    /// corner, moved by (dx, dy) pixels. Thread-safe.
    virtual std::array<double, 3> color_at(double x, double y, double dx, double dy) const = 0;
};

/// `kind` must not be none. The scene need not outlive this call.
std::unique_ptr<ReferenceTracer> make_reference_tracer(const Scene& scene, ReferenceKind kind);

}  // namespace rt
