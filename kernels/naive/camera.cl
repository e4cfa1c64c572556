// SPDX-License-Identifier: Apache-2.0
//
// Eye rays that do not know what surface the eye lies on.
#ifndef RT_NAIVE_CAMERA_CL
#define RT_NAIVE_CAMERA_CL

#include "kernels/naive/power.cl"

#if RT_NAIVE_OFFSETS
#define camera_ray robust_camera_ray
#endif
#include "kernels/camera.cl"
#undef camera_ray

#if RT_NAIVE_OFFSETS
Ray camera_ray(const Frame* frame, Indices x, Indices y, Indices k) {
    Ray ray = robust_camera_ray(frame, x, y, k);
    ray.from = (Indices)RT_NONE;
    return ray;
}
#endif

#endif
