// SPDX-License-Identifier: Apache-2.0
//
// The nearest hit, and of several as near the one that was found first.
#ifndef RT_NAIVE_CLOSEST_HIT_CL
#define RT_NAIVE_CLOSEST_HIT_CL

#include "kernels/naive/bvh.cl"
#include "kernels/naive/intersect.cl"

#if RT_NAIVE_TIES
#define offer_hit robust_offer_hit
#endif
#include "kernels/search.cl"
#undef offer_hit

#if RT_NAIVE_TIES
void offer_hit(const SceneView* scene, Search* search, Mask lanes, Reals t, Reals u, Reals v,
               Index prim) {
    Mask better = lanes & (t > (Reals)0) & (t < search->hit.t);
    if (!any_lane(better)) return;
    search->hit.t = better ? t : search->hit.t;
    search->hit.u = better ? u : search->hit.u;
    search->hit.v = better ? v : search->hit.v;
    search->hit.prim = better ? (Indices)prim : search->hit.prim;
    search->limit = search->hit.t;
}
#define closest_hit robust_closest_hit
#endif
#include "kernels/closest_hit.cl"
#undef closest_hit

#if RT_NAIVE_TIES
Hit closest_hit(const SceneView* scene, const Ray* ray, Mask live) {
    RayShear shear = make_shear(ray, live);
    Search search;
    search.hit.t = live ? (Reals)INFINITY : (Reals)-1;
    search.hit.u = search.hit.v = (Reals)0;
    search.hit.prim = (Indices)RT_NONE;
    search.hit.tied = RT_NO_LANES;
    search.limit = search.hit.t;
    search_all(scene, ray, &shear, &search);
    return search.hit;
}
#endif

#endif
