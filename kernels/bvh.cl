// SPDX-License-Identifier: Apache-2.0
//
// The leaves of a bounding volume hierarchy that a packet of rays meets, the nearer ones first.
//
// Nothing is ever missed: boxes are enlarged on the host by the rounding of the vertices
// (host/flatten/bvh.cpp) and here by that of the origin, 8 half-ulps each; the far distance is
// stretched by the rounding of the slab test (Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013); and
// a NaN, 0 * infinity where a ray runs in a box's face, leaves the interval as it is.
#ifndef RT_BVH_CL
#define RT_BVH_CL

#include "kernels/intersect.cl"

#define RT_FAR ((Real)1 + (Real)6 * (Real)RT_ROUNDOFF)

typedef struct {
    real3 low_origin, high_origin;  // what the boxes' low and high corners are seen from
    real3 inverse;                  // of the direction
    Index whole;                    // primitives of the kind in hand, when it has no hierarchy
    Index size;                     // of the stack
    Index stack[RT_BVH_STACK];      // nodes to visit
} Traversal;

Traversal begin_traversal(const Ray* ray) {
    Traversal traversal;
    if (RT_HAS_HIERARCHY) {
        real3 size = abs3(ray->origin);
        Reals reach = (Reals)((Real)8 * (Real)RT_ROUNDOFF) * max_of(size.x, max_of(size.y, size.z));
        real3 margin = make3(reach, reach, reach);
        traversal.low_origin = add3(ray->origin, margin);
        traversal.high_origin = sub3(ray->origin, margin);
        traversal.inverse =
            make3((Reals)1 / ray->dir.x, (Reals)1 / ray->dir.y, (Reals)1 / ray->dir.z);
    }
    return traversal;
}

// Turns to a kind of primitive: `count` of them under the node `root`, or under none.
void enter_kind(Traversal* traversal, Index root, Index count) {
    traversal->whole = count;
    traversal->size = 1;
    if (RT_HAS_HIERARCHY) traversal->stack[0] = root;
}

// Narrows [near, far] to where a ray lies between two planes.
void clip_to_slab(Reals low, Reals high, Reals inverse, Reals* near, Reals* far) {
    Reals a = low * inverse;
    Reals b = high * inverse;
    Mask backward = inverse < (Reals)0;
    Reals enter = backward ? b : a;
    Reals leave = backward ? a : b;
    *near = enter > *near ? enter : *near;
    *far = leave < *far ? leave : *far;
}

// The lanes whose rays meet the box no later than t_max, and where they enter it.
Mask meets_box(const Traversal* traversal, __global const BvhNode* node, Reals t_max,
               Reals* entry) {
    Reals near = (Reals)0;
    Reals far = (Reals)INFINITY;
    clip_to_slab(node->low.x - traversal->low_origin.x, node->high.x - traversal->high_origin.x,
                 traversal->inverse.x, &near, &far);
    clip_to_slab(node->low.y - traversal->low_origin.y, node->high.y - traversal->high_origin.y,
                 traversal->inverse.y, &near, &far);
    clip_to_slab(node->low.z - traversal->low_origin.z, node->high.z - traversal->high_origin.z,
                 traversal->inverse.z, &near, &far);
    *entry = near;
    return (near <= far * RT_FAR) & (near <= t_max);
}

// Puts those of an inner node's two that some ray meets on the stack, the nearer one on top.
void push_children(Traversal* traversal, __global const BvhNode* nodes, Index first, Reals t_max) {
    Reals entry, other_entry;
    Mask meets = meets_box(traversal, &nodes[first], t_max, &entry);
    Mask meets_other = meets_box(traversal, &nodes[first + 1], t_max, &other_entry);
    bool pushes = any_lane(meets);
    bool pushes_other = any_lane(meets_other);
    if (pushes & pushes_other) {
        Index nearer = any_lane(meets & meets_other & (other_entry < entry)) ? 1 : 0;
        traversal->stack[traversal->size++] = first + 1 - nearer;
        traversal->stack[traversal->size++] = first + nearer;
    } else if (pushes | pushes_other) {
        traversal->stack[traversal->size++] = first + (pushes ? 0 : 1);
    }
}

// The next primitives that some ray may meet no later than its t_max: first.., before end. False
// when there are no more.
bool next_range(Traversal* traversal, __global const BvhNode* nodes, Reals t_max, Index* first,
                Index* end) {
    while (traversal->size > 0) {
        traversal->size -= 1;
        Index place = RT_HAS_HIERARCHY ? traversal->stack[traversal->size] : 0;
        if (place == 0) {
            *first = 0;
            *end = traversal->whole;
            return true;
        }
        __global const BvhNode* node = &nodes[place];
        if (node->count > 0) {
            *first = node->first;
            *end = node->first + node->count;
            return true;
        }
        push_children(traversal, nodes, node->first, t_max);
    }
    return false;
}

#endif
