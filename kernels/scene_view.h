// SPDX-License-Identifier: Apache-2.0
//
// The scene as device functions see it: the arrays and the frame, gathered once in the entry
// point.
#ifndef RT_SCENE_VIEW_H
#define RT_SCENE_VIEW_H

#include "kernels/features.h"
#include "kernels/lanes.h"

// With hierarchies, order[i] is the number that primitive i had in the scene's own order; casters
// lists each light's triangles that can cast a shadow.
#define RT_SCENE_FIELD(type, name, what) __global const type* name;
typedef struct {
    RT_SCENE_ARRAYS(RT_SCENE_FIELD)
    LaunchParams params;
} SceneView;

// Primitives are numbered spheres first, then cones, then triangles.
Index first_triangle(const SceneView* scene) {
    return scene->params.sphere_count + scene->params.cone_count;
}

typedef struct {
    real3 origin;
    real3 dir;         // unit
    real3 dir_low;     // of eye rays: what rounding took from dir; else 0
    real3 origin_low;  // of others: from the origin to the point left; of eye rays 0
    Reals t_max;       // hits lie in (0, t_max]; a negative one switches the lane off
    // Known of its other hit with the curved surface that it leaves: a sphere's distance to it; of
    // a cone -2 b, where a t^2 + 2 b t is what it solves.
    Reals self_hit;
    Indices from;  // the primitive the origin lies on, or RT_NONE
} Ray;

typedef struct {
    Reals t, u, v;  // u, v: weights of a triangle's second and third vertex
    Indices prim;   // RT_NONE: a miss
    Mask tied;      // several surfaces meet within rounding
} Hit;

// Rays traced by each lane.
typedef struct {
    Indices shadow, mirror, transmitted;
} PacketCounts;

#endif
