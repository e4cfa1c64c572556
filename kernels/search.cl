// SPDX-License-Identifier: Apache-2.0
//
// What a pass over the primitives keeps of its hits.
//
// Ties: surfaces within 32 half-ulps (of the nearest hit's distance plus the origin's from the eye)
// count as one surface, and the first of them in the scene is hit. That set does not depend on the
// order of the tests, so neither does the picture: a first pass finds the two smallest distances,
// and only if they lie that close does a second pass look for the first in the scene. Rays through
// the shared edges of the paper's box need it (they project onto the picture's diagonals); hardly
// any other rays do.
#ifndef RT_SEARCH_CL
#define RT_SEARCH_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// What a pass over the primitives has found.
typedef struct {
    Hit hit;
    Reals second;      // first pass: the next distance after hit.t
    Indices number;    // second pass: the hit primitive's number in the scene
    Reals limit;       // farther hits do not count; negative: the lane is off
    Reals slack;       // RT_TIE of the origin's distance from the eye
    bool finds_first;  // second pass: find the first in the scene, not the nearest
} Search;

// A primitive's number in the scene: hierarchies reorder them.
Index scene_number(const SceneView* scene, Index prim) {
    if (!RT_HAS(HIERARCHY)) return prim;
    bool reordered =
        (scene->params.sphere_root | scene->params.cone_root | scene->params.triangle_root) != 0;
    return reordered ? scene->order[prim] : prim;
}

// The numbers of the primitives in the live lanes.
Indices scene_numbers(const SceneView* scene, Indices prims, Mask live) {
    Indices numbers = prims;
    for (Mask left = live; any_lane(left);) {
        Index prim = least_lane(left, prims);
        Mask lanes = left & (prims == prim);
        left &= !lanes;
        numbers = lanes ? (Indices)scene_number(scene, prim) : numbers;
    }
    return numbers;
}

// How far surfaces reach that count as one with a surface at t.
Reals end_of_tie(const Search* search, Reals t) {
    Reals end = t * ((Real)1 + RT_TIE) + search->slack;
    return RT_HAS(GLASS) ? max_of(end, t + search->hit.behind) : end;
}

// Records primitive prim, which the lines of some lanes meet at t (possibly behind the origin, or
// NaN). `behind` as in Hit.
void offer_hit(const SceneView* scene, Search* search, Mask lanes, Reals t, Reals u, Reals v,
               Reals behind, Index prim) {
    Mask met = lanes & (t > (Reals)0) & (t <= search->limit);
    if (!any_lane(met)) return;
    Mask better = met & (t < search->hit.t);
    if (search->finds_first) {
        Index number = scene_number(scene, prim);
        better = met & (number < search->number);
        search->number = better ? (Indices)number : search->number;
    } else {
        Reals runner_up = t < search->second ? t : search->second;
        search->second = better ? search->hit.t : (met ? runner_up : search->second);
        Mask nearest = better;
        if (RT_HAS(GLASS)) {  // the same where several are nearest, in whatever order
            Mask as_near = met & (t == search->hit.t);
            behind = as_near ? max_of(behind, search->hit.behind) : behind;
            nearest |= as_near;
            search->hit.behind = nearest ? behind : search->hit.behind;
        }
        search->limit = nearest ? end_of_tie(search, t) : search->limit;
    }
    search->hit.t = better ? t : search->hit.t;
    search->hit.u = better ? u : search->hit.u;
    search->hit.v = better ? v : search->hit.v;
    search->hit.prim = better ? (Indices)prim : search->hit.prim;
}

#endif
