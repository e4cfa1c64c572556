// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "host/image/picture.h"
#include "host/scene/scene.h"
#include "host/stress/stress_case.h"

namespace rt {

/// Renders a scene according to docs/scene-format.md, by textbook formulas in wide arithmetic on
/// the author's own coordinates: nothing is recentered, scaled or shared with the renderers.
/// Surfaces closer together than 1e-12 of the distance count as one, the first in the scene.
///
/// Returns linear light, not clamped, at the point (x, y) of the picture, in pixels from its top
/// left corner, moved by (dx, dy) pixels. Thread-safe.
using ReferenceTracer = std::function<glm::dvec3(double x, double y, double dx, double dy)>;

/// `kind` must not be none. The scene need not outlive this call.
ReferenceTracer make_reference_tracer(const Scene& scene, ReferenceKind kind);

/// The largest difference of a channel, clamped to [0, 1]; infinite with a NaN.
double color_difference(const glm::dvec3& a, const glm::dvec3& b);

/// The correct picture of a scene, and which of its pixels lie at edges.
class ReferencePicture {
   public:
    /// Traces every pixel, on all cores.
    ReferencePicture(const Scene& scene, ReferenceKind kind);

    /// Color of a pixel, counted row by row from the top left; linear, not clamped.
    const glm::dvec3& color(std::size_t pixel) const { return colors_[pixel]; }

    /// Whether a pixel lies at an edge: a channel, clamped to [0, 1], changes by more than 0.5/255
    /// as the samples move by 0.02 pixel. Traced on first use. Threads may ask about different
    /// pixels.
    bool is_at_edge(std::size_t pixel);

    Picture as_picture() const;

   private:
    glm::dvec3 pixel_color(std::size_t pixel, glm::dvec2 move) const;

    int width_, height_;
    int grid_;
    ReferenceTracer tracer_;
    std::vector<glm::dvec3> colors_;
    std::vector<std::int8_t> edges_;  ///< 1 yes, 0 no, -1 not known yet
};

}  // namespace rt
