// SPDX-License-Identifier: Apache-2.0
//
// Visits the leaves of a bounding volume hierarchy that a packet of rays meets, nearer ones first.
//
// Never misses a hit: the host enlarges boxes by 16 half-ulps of their largest coordinate
// (host/flatten/flat_shapes.h), and here they grow by 16 half-ulps of the origin's. That exceeds
// the combined rounding errors of the vertices in the rays' frames and of the slab test (after Ize,
// Robust BVH Ray Traversal, JCGT 2(2), 2013, whose bound is relative to the distance; with a bound
// relative to the coordinates a plane's distance may be one fma).
#ifndef RT_BVH_CL
#define RT_BVH_CL

#include "kernels/intersect.cl"

#if RT_LANES > 1 && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define RT_HAS_PREFETCH
#endif
#endif

typedef struct {
    real3 inverse;  // of the direction
    // Rays meet a box's planes at t = plane x inverse + first_at (entry) or last_at (exit).
    real3 first_at, last_at;
    bool is_uniform;       // along each axis all rays go the same way; else first_at is for the
                           // low planes and last_at for the high ones
    Index low_or_high[3];  // entry planes' place in a node: 0 for low, 4 for high
    __global const char* prims;  // of the current kind
    Index prim_size;
    Index whole;                // primitives of the current kind, if it has no hierarchy
    Index size;                 // of the stack
    Index stack[RT_BVH_STACK];  // RT_NONE, then nodes to visit
} Traversal;

// 1 / d, kept finite: a direction component this small never leaves the boxes' margin.
Reals finite_inverse(Reals d) {
    Reals least = (Reals)RT_LEAST_DIRECTION;
    Reals away = d < (Reals)0 ? -least : least;
    return (Reals)1 / (fabs(d) < least ? away : d);
}

// Whether v has the same sign in all live lanes; then *positive tells which.
bool is_one_way(Reals v, Mask live, bool* positive) {
    bool any_positive = any_lane(live & (v > (Reals)0));
    *positive = any_positive;
    return !(any_positive & any_lane(live & (v < (Reals)0)));
}

Traversal begin_traversal(const Ray* ray, Mask live) {
    Traversal traversal;
    traversal.size = 0;
    if (RT_HAS(HIERARCHY)) {
        real3 inverse = make3(finite_inverse(ray->dir.x), finite_inverse(ray->dir.y),
                              finite_inverse(ray->dir.z));
        real3 size = abs3(ray->origin);
        Reals reach =
            (Reals)((Real)16 * (Real)RT_ROUNDOFF) * max_of(size.x, max_of(size.y, size.z));
        real3 margin = make3(reach, reach, reach);
        real3 low_at = negate3(mul3(add3(ray->origin, margin), inverse));
        real3 high_at = negate3(mul3(sub3(ray->origin, margin), inverse));
        bool x_up, y_up, z_up;
        bool x = is_one_way(inverse.x, live, &x_up);
        bool y = is_one_way(inverse.y, live, &y_up);
        bool z = is_one_way(inverse.z, live, &z_up);
        bool uniform = x & y & z;
        x_up |= !uniform;
        y_up |= !uniform;
        z_up |= !uniform;
        traversal.inverse = inverse;
        traversal.is_uniform = uniform;
        traversal.low_or_high[0] = x_up ? 0 : 4;
        traversal.low_or_high[1] = y_up ? 0 : 4;
        traversal.low_or_high[2] = z_up ? 0 : 4;
        traversal.first_at = make3(x_up ? low_at.x : high_at.x, y_up ? low_at.y : high_at.y,
                                   z_up ? low_at.z : high_at.z);
        traversal.last_at = make3(x_up ? high_at.x : low_at.x, y_up ? high_at.y : low_at.y,
                                  z_up ? high_at.z : low_at.z);
    }
    return traversal;
}

// Starts on a kind of primitive: `count` of them, under the node `root`, or without a hierarchy if
// root is 0.
void enter_kind(Traversal* traversal, Index root, Index count, __global const void* prims,
                Index prim_size) {
    traversal->prims = (__global const char*)prims;
    traversal->prim_size = prim_size;
    traversal->whole = count;
    traversal->size = 2;
    if (RT_HAS(HIERARCHY)) {
        traversal->stack[0] = RT_NONE;
        traversal->stack[1] = root;
    }
}

// Where the rays meet three planes of a box; p points at the node's low.x.
real3 plane_distances(__global const Real* p, Index x, Index y, Index z, real3 inverse, real3 at) {
    return make3(fma((Reals)p[x], inverse.x, at.x), fma((Reals)p[1 + y], inverse.y, at.y),
                 fma((Reals)p[2 + z], inverse.z, at.z));
}

// The lanes whose rays meet the box no later than t_max, and where they enter it. The operands are
// ordered so that a NaN leaves the interval unchanged.
Mask meets_box(const Traversal* traversal, __global const BvhNode* node, Reals t_max,
               Reals* entry) {
    __global const Real* p = &node->low.x;
    const Index x = traversal->low_or_high[0];
    const Index y = traversal->low_or_high[1];
    const Index z = traversal->low_or_high[2];
    real3 enter = plane_distances(p, x, y, z, traversal->inverse, traversal->first_at);
    real3 leave = plane_distances(p, 4 - x, 4 - y, 4 - z, traversal->inverse, traversal->last_at);
    if (!traversal->is_uniform) {
        real3 first = enter;
        enter = make3(min_of(first.x, leave.x), min_of(first.y, leave.y), min_of(first.z, leave.z));
        leave = make3(max_of(first.x, leave.x), max_of(first.y, leave.y), max_of(first.z, leave.z));
    }
    Reals near = max_of(max_of(enter.x, enter.y), max_of(enter.z, (Reals)0));
    Reals far = min_of(min_of(leave.x, leave.y), min_of(leave.z, t_max));
    *entry = near;
    return near <= far;
}

// Starts to load a node's children or primitives: on CPUs, where packets run, memory takes longer
// than the tests of two boxes.
void prefetch_inside(const Traversal* traversal, __global const BvhNode* nodes, Index node) {
#ifdef RT_HAS_PREFETCH
    Index first = nodes[node].first;
    __global const void* inside =
        nodes[node].count > 0
            ? (__global const void*)(traversal->prims + (long)first * traversal->prim_size)
            : (__global const void*)&nodes[first];
    __builtin_prefetch((const void*)(ulong)inside);
#endif
}

// The next node after an inner one whose children start at `first`: the child that some ray meets;
// if both are met, the nearer one, and the other is pushed; if neither is, the node on top of the
// stack. For packets without branches: which of these it is cannot be predicted, and CPUs lose more
// time over a wrong guess than over the rest (an all-mirror mesh takes .92 of the time).
Index enter_children(Traversal* traversal, __global const BvhNode* nodes, Index first,
                     Reals t_max) {
    Reals entry, other_entry;
    prefetch_inside(traversal, nodes, first);
    prefetch_inside(traversal, nodes, first + 1);
    Mask meets = meets_box(traversal, &nodes[first], t_max, &entry);
    Mask meets_other = meets_box(traversal, &nodes[first + 1], t_max, &other_entry);
    bool enters = any_lane(meets);
    bool enters_other = any_lane(meets_other);
    if (RT_LANES == 1 && !(enters & enters_other)) {
        if (enters) return first;
        if (enters_other) return first + 1;
        traversal->size -= 1;
        return traversal->stack[traversal->size];
    }
    Index nearer = any_lane(meets & meets_other & (other_entry < entry)) ? 1 : 0;
    Index size = traversal->size;
    Index top = traversal->stack[size - 1];
    traversal->stack[size] = first + 1 - nearer;
    traversal->size = size + (enters ? 1 : 0) + (enters_other ? 1 : 0) - 1;
    return (enters | enters_other) ? first + (nearer | (enters ? 0 : 1)) : top;
}

// Whether there is another range of primitives, [first, end), that some ray may meet no later than
// its t_max.
bool next_range(Traversal* traversal, __global const BvhNode* nodes, Reals t_max, Index* first,
                Index* end) {
    traversal->size -= 1;
    // Without hierarchies the stack would hold RT_NONE and 0.
    Index place = RT_HAS(HIERARCHY) ? traversal->stack[traversal->size] : traversal->size - 1;
    while (RT_HAS(HIERARCHY) && place > 0) {
        __global const BvhNode* node = &nodes[place];
        if (node->count > 0) {
            *first = node->first;
            *end = node->first + node->count;
            return true;
        }
        place = enter_children(traversal, nodes, node->first, t_max);
    }
    *first = 0;
    *end = traversal->whole;
    return place == 0;
}

#endif
