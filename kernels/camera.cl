// SPDX-License-Identifier: Apache-2.0
//
// Eye rays. One affine map serves perspective (origin fixed) and orthographic (direction fixed)
// cameras. sx and sy are exact in the sample position, so a square picture has equal sx and sy on
// its diagonal, to the bit.
//
// A direction carries the part lost to rounding, traced back to the author's camera: at a ball a
// thousandth of its distance wide, half an ulp of the direction counts a thousandfold.
#ifndef RT_CAMERA_CL
#define RT_CAMERA_CL

#include "kernels/math.cl"
#include "kernels/sampling.cl"
#include "kernels/scene_view.h"

// The ray through this place in pixel (x, y), x to the right and y up.
Ray position_ray(const LaunchParams* params, Indices x, Indices y, Position offset) {
    Reals sx = (Reals)2 * (RT_TO_REALS(x) + offset.x) - (Real)params->width;
    Reals sy = (Reals)2 * (RT_TO_REALS(y) + offset.y) - (Real)params->height;
    real3 direction = load3(params->direction);
    real3 dx = load3(params->direction_dx);
    real3 dy = load3(params->direction_dy);
    real3 across = add_scaled(direction, sx, dx);
    real3 through = add_scaled(across, sy, dy);
    Reals inverse = (Reals)1 / length3(through);
    Ray ray;
    ray.dir = scale3(inverse, through);
    ray.dir_low = make3((Reals)0, (Reals)0, (Reals)0);
    ray.origin_low = ray.dir_low;
    if (RT_HAS(SPHERES)) {
        real3 low = add_scaled(load3(params->direction_low), sx, load3(params->direction_dx_low));
        low = add_scaled(low, sy, load3(params->direction_dy_low));
        low = add3(low, fma_error3(direction, sx, dx, across));
        low = add3(low, fma_error3(across, sy, dy, through));
        ray.dir_low = add_scaled(add_scaled(negate3(ray.dir), inverse, through), inverse, low);
    }
    ray.origin = add_scaled(scale3(sx, load3(params->origin_dx)), sy, load3(params->origin_dy));
    ray.t_max = (Reals)INFINITY;
    ray.self_hit = (Reals)0;
    ray.from = (Indices)(params->eye_on_surface != 0 ? RT_EYE : RT_NONE);
    ray.zone = (Reals)0;
    ray.left = ray.left_side = (Indices)0;
    return ray;
}

// The ray through sample k of pixel (x, y).
Ray camera_ray(const LaunchParams* params, Indices x, Indices y, Indices k) {
    return position_ray(params, x, y, sample_position(params, x, y, k));
}

#endif
