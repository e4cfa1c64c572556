// SPDX-License-Identifier: Apache-2.0
//
// The tracer compiled to report what a path meets: in double, one ray at a time. Same source, same
// bits; RT_EXPLAIN, empty in the rendering kernels, reports to the host.
#define RT_OUT_OF_LINE __attribute__((noinline))

#include "kernels/math.cl"
#include "kernels/native/path_event.h"

void rt_note_path_event(const PathEvent* event);  // host/explain/ray_tree.cpp

void set_triple(double* to, real3 v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

void explain_event(Mask live, int what, Indices index, Index bounce, Reals distance, real3 weight,
                   real3 point, real3 normal, real3 color) {
    if (!live) return;
    PathEvent event;
    event.what = what;
    event.index = index;
    event.bounce = bounce;
    event.distance = distance;
    set_triple(event.weight, weight);
    set_triple(event.point, point);
    set_triple(event.normal, normal);
    set_triple(event.color, color);
    rt_note_path_event(&event);
}

#define RT_EXPLAIN explain_event

#include "kernels/items.cl"

// Renders the pixel of a one-pixel tile.
void rt_explain_pixel(__global Real* film, __global RayCounts* counts, const SceneView* view,
                      const Tile* tile) {
    SceneView scene = *view;
    add_counts(counts, 0, pixels_item(film, &scene, tile, 0, 1));
}
