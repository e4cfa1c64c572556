// SPDX-License-Identifier: Apache-2.0
//
// The scene as device functions see it: the arrays and launch parameters, gathered once in the
// entry point.
#ifndef RT_SCENE_VIEW_H
#define RT_SCENE_VIEW_H

#include "kernels/features.h"
#include "kernels/lanes.h"

// With hierarchies, order[i] is primitive i's number in the scene's own order; casters lists each
// light's triangles that can cast a shadow.
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
    real3 dir_low;     // eye rays: the part of dir lost to rounding; others: 0
    real3 origin_low;  // eye rays: 0; others: from the origin to the surface point left
    Reals t_max;       // hits lie in (0, t_max]; a negative one switches the lane off
    // For the second hit with the curved surface the ray leaves: on a sphere its distance; on a
    // cone -2 b, where the ray solves a t^2 + 2 b t = 0.
    Reals self_hit;
    Indices from;  // the primitive the origin lies on, or RT_NONE
    // A refracted ray that left several surfaces at once: up to `zone`, surfaces that come before
    // number `left` in the scene, or have that side and material, are behind it. Else zone is 0.
    Reals zone;
    Indices left, left_side;
} Ray;

// Surfaces count as one within this share of t and the origin's distance from the eye.
#define RT_TIE ((Real)32 * (Real)RT_ROUNDOFF)

typedef struct {
    Reals t, u, v;  // u, v: weights of a triangle's second and third vertex
    Indices prim;   // RT_NONE: a miss
    Mask tied;      // several surfaces meet within rounding
    Reals behind;  // how far behind glass that is hit other surfaces count as tied, if above RT_TIE
} Hit;

// Rays traced by each lane.
typedef struct {
    Indices shadow, mirror, transmitted;
    Reals signature;  // of what they met (kernels/signature.cl), 24 bits
} PacketCounts;

#endif
