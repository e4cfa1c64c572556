// SPDX-License-Identifier: Apache-2.0
#include "host/render/explain.h"

#include "host/render/native_kernels.h"

using rt::f64::RayCounts;
using rt::f64::Tile;

extern "C" {
void rt_explain_pixel(double* film, RayCounts* counts, const rt::NativeView<double>* view,
                      const Tile* tile);
void rt_note_path_event(const PathEvent* event);
}

namespace {

thread_local std::vector<PathEvent>* listener = nullptr;

}  // namespace

void rt_note_path_event(const PathEvent* event) { listener->push_back(*event); }

namespace rt {

ExplainedPixel explain_pixel(const FlatScene<double>& scene, int x, int y) {
    ExplainedPixel pixel;
    const NativeView<double> view = native_view(scene);
    const Tile tile{x, y, 1, 1, 0, 1, {}};
    RayCounts counts{};
    listener = &pixel.events;
    rt_explain_pixel(&pixel.color.x, &counts, &view, &tile);
    listener = nullptr;
    return pixel;
}

}  // namespace rt
