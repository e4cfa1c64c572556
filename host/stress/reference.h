// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/image/picture.h"
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

/// The correct picture of a scene, and which of its pixels lie at edges.
class ReferencePicture {
   public:
    /// Traces every pixel, on all cores.
    ReferencePicture(const Scene& scene, ReferenceKind kind);

    /// Color of a pixel, counted row by row from the top left; linear, not clamped.
    const std::array<double, 3>& color(std::size_t pixel) const { return colors_[pixel]; }

    /// Which of these pixels lie at an edge: a channel, clamped to [0, 1], changes by more than
    /// 0.5/255 as the samples move by 0.02 pixel. Traced on first use, on all cores.
    std::vector<bool> at_edges(std::span<const std::size_t> pixels);

    Picture as_picture() const;

   private:
    std::array<double, 3> pixel_color(std::size_t pixel, double dx, double dy) const;
    bool changes_nearby(std::size_t pixel) const;

    int width_, height_;
    int grid_;
    std::unique_ptr<ReferenceTracer> tracer_;
    std::vector<std::array<double, 3>> colors_;
    std::vector<std::int8_t> edges_;  ///< 1 yes, 0 no, -1 not known yet
};

}  // namespace rt
