// SPDX-License-Identifier: Apache-2.0
//
// Signatures of ray trees, for an edges mode: samples on both sides of an edge have different ones.
// A signature tells which surfaces the rays of a sample meet and on which side, which lights reach
// them, and which rays go on.
#ifndef RT_SIGNATURE_CL
#define RT_SIGNATURE_CL

#include "kernels/sampling.cl"
#include "kernels/search.cl"

// Whether anybody reads the signatures.
bool has_signatures(const SceneView* scene) {
    return RT_HAS(EDGES) && scene->params.tolerance > (Real)0;
}

// Adds a number to the signatures of these lanes.
void sign_lanes(const SceneView* scene, PacketCounts* counts, Mask lanes, Indices number) {
    if (!has_signatures(scene)) return;
    Uints before = RT_TO_UINTS(RT_TO_INDICES(counts->signature)) << 8;
    Uints after = hash_bits(before ^ RT_TO_UINTS(number));
    counts->signature = lanes ? RT_TO_REALS(after >> 8) : counts->signature;
}

// A coordinate as the number of its cell.
uint cell(Real coordinate, Real cells) {
    Real limit = (Real)0x1p20f;
    coordinate = coordinate < limit ? coordinate : limit;
    return (uint)(int)((coordinate > -limit ? coordinate : -limit) * cells);
}

// A number that primitives share if there is no edge where they meet: flat triangles in a plane,
// and smooth ones of a material. An edge among the latter shows in its colors, or not at all.
Index surface_number(const SceneView* scene, Index prim) {
    Index index = prim - first_triangle(scene);
    if (!RT_HAS(TRIANGLES) || index < 0) return scene_number(scene, prim);
    __global const Triangle* triangle = &scene->triangles[index];
    if (RT_HAS(VERTEX_NORMALS) && triangle->smooth != RT_NONE) return -1 - triangle->material;
    uint number = (uint)triangle->material;
    number = number * 0x9e3779b1u + cell(triangle->normal.x, (Real)2020.7f);
    number = number * 0x9e3779b1u + cell(triangle->normal.y, (Real)2020.7f);
    number = number * 0x9e3779b1u + cell(triangle->normal.z, (Real)2020.7f);
    return (Index)(number * 0x9e3779b1u + cell(triangle->plane, (Real)1020.7f));
}

// Adds to the signatures of these lanes which surfaces they meet, `inside` where from behind.
void sign_surfaces(const SceneView* scene, PacketCounts* counts, Mask lanes, Indices prims,
                   Mask inside) {
    if (!has_signatures(scene)) return;
    Indices numbers = (Indices)0;
    for (Mask left = lanes; any_lane(left);) {
        Index prim = least_lane(left, prims);
        Mask same = left & (prims == prim);
        left &= !same;
        numbers = same ? (Indices)surface_number(scene, prim) : numbers;
    }
    sign_lanes(scene, counts, lanes, numbers);
    sign_lanes(scene, counts, lanes, inside & 1);
}

#endif
