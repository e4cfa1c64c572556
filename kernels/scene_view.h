// SPDX-License-Identifier: Apache-2.0
//
// The scene as device functions see it: the buffers and the frame, gathered once in the entry
// point.
#ifndef RT_SCENE_VIEW_H
#define RT_SCENE_VIEW_H

#include "kernels/features.h"
#include "kernels/types.h"

typedef struct {
    __global const Sphere* spheres;
    __global const Triangle* triangles;
    __global const VertexNormals* vertex_normals;
    __global const Material* materials;
    __global const Light* lights;
    Frame frame;
} SceneView;

// Primitives are numbered spheres first, then triangles.
typedef struct {
    real3 origin;
    real3 dir;   // unit
    Real t_max;  // hits lie in (0, t_max]
    Index from;  // the primitive the origin lies on, or RT_NONE
} Ray;

typedef struct {
    Real t, u, v;  // u, v: weights of a triangle's second and third vertex
    Index prim;    // RT_NONE: a miss
    Index tied;    // 1 where several surfaces meet within rounding
} Hit;

#endif
