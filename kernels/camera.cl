// SPDX-License-Identifier: Apache-2.0
//
// Eye rays. One affine map serves perspective (origin fixed) and orthographic (direction fixed)
// cameras. sx and sy are exact in the sample position, so a square picture has equal sx and sy on
// its diagonal, to the bit.
#ifndef RT_CAMERA_CL
#define RT_CAMERA_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// The ray through sample k of pixel (x, y), x to the right and y up; sample k lies at column
// k % grid and row k / grid of the pixel's grid, at (i + 0.5) / grid.
Ray camera_ray(const Frame* frame, Index x, Index y, Index k) {
    Real grid = (Real)frame->grid;
    Real offset_x = ((Real)(k % frame->grid) + (Real)0.5) / grid;
    Real offset_y = ((Real)(k / frame->grid) + (Real)0.5) / grid;
    Real sx = (Real)2 * ((Real)x + offset_x) - (Real)frame->width;
    Real sy = (Real)2 * ((Real)y + offset_y) - (Real)frame->height;
    real3 across = add_scaled(load3(frame->direction), sx, load3(frame->direction_dx));
    Ray ray;
    ray.dir = normalize3(add_scaled(across, sy, load3(frame->direction_dy)));
    ray.origin = add_scaled(scale3(sx, load3(frame->origin_dx)), sy, load3(frame->origin_dy));
    ray.t_max = INFINITY;
    ray.from = RT_NONE;
    return ray;
}

#endif
