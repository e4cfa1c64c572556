// SPDX-License-Identifier: Apache-2.0
//
// Eye rays. One affine map serves perspective (origin fixed) and orthographic (direction fixed)
// cameras. sx and sy are exact in the sample position, so a square picture has equal sx and sy on
// its diagonal, to the bit.
#ifndef RT_CAMERA_CL
#define RT_CAMERA_CL

#include "kernels/math.cl"
#include "kernels/sampling.cl"
#include "kernels/scene_view.h"

// The ray through sample k of pixel (x, y), x to the right and y up.
Ray camera_ray(const Frame* frame, Indices x, Indices y, Indices k) {
    Position offset = sample_position(frame, x, y, k);
    Reals sx = (Reals)2 * (RT_TO_REALS(x) + offset.x) - (Real)frame->width;
    Reals sy = (Reals)2 * (RT_TO_REALS(y) + offset.y) - (Real)frame->height;
    real3 across = add_scaled(load3(frame->direction), sx, load3(frame->direction_dx));
    Ray ray;
    ray.dir = normalize3(add_scaled(across, sy, load3(frame->direction_dy)));
    ray.origin = add_scaled(scale3(sx, load3(frame->origin_dx)), sy, load3(frame->origin_dy));
    ray.t_max = (Reals)INFINITY;
    ray.from = (Indices)RT_NONE;
    return ray;
}

#endif
