// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "host/scene/scene.h"
#include "host/stress/stress_case.h"

namespace rt {

/// What a scene shows according to docs/scene-format.md, by textbook formulas in wide arithmetic on
/// the author's own coordinates: nothing is recentered, scaled, bounded or shared with the
/// renderers. Surfaces nearer to each other than 1e-12 of the distance are one, the first in the
/// scene.
class ReferenceTracer {
   public:
    virtual ~ReferenceTracer() = default;

    /// Linear light, not clamped, of the point (x, y) of the picture, pixels from its top left
    /// corner, moved by (dx, dy) pixels. Any thread may ask.
    virtual std::array<double, 3> color_at(double x, double y, double dx, double dy) const = 0;
};

/// `kind` is not none. The scene may go once this returns.
std::unique_ptr<ReferenceTracer> make_reference_tracer(const Scene& scene, ReferenceKind kind);

}  // namespace rt
