// SPDX-License-Identifier: Apache-2.0
//
// Boxes without margins for rounding: the plain slab test.
#ifndef RT_NAIVE_BVH_CL
#define RT_NAIVE_BVH_CL

#include "kernels/naive/intersect.cl"

#if RT_NAIVE_BOXES
#define begin_traversal robust_begin_traversal
#endif
#include "kernels/bvh.cl"
#undef begin_traversal

#if RT_NAIVE_BOXES
Traversal begin_traversal(const Ray* ray, Mask live) {
    Traversal traversal;
    if (RT_HAS_HIERARCHY) {
        traversal.inverse =
            make3((Reals)1 / ray->dir.x, (Reals)1 / ray->dir.y, (Reals)1 / ray->dir.z);
        traversal.first_at = negate3(mul3(ray->origin, traversal.inverse));
        traversal.last_at = traversal.first_at;
        bool x_up, y_up, z_up;
        bool x = is_one_way(traversal.inverse.x, live, &x_up);
        bool y = is_one_way(traversal.inverse.y, live, &y_up);
        bool z = is_one_way(traversal.inverse.z, live, &z_up);
        bool uniform = x & y & z;
        traversal.is_uniform = uniform;
        traversal.low_or_high[0] = (x_up | !uniform) ? 0 : 4;
        traversal.low_or_high[1] = (y_up | !uniform) ? 0 : 4;
        traversal.low_or_high[2] = (z_up | !uniform) ? 0 : 4;
    }
    return traversal;
}
#endif

#endif
