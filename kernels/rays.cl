// SPDX-License-Identifier: Apache-2.0
//
// Traces single rays, in packets as for pictures, for the stress suite and the tests on every
// device. A query's ray is traced to its closest hit and, if `next` says so, on from there as a
// mirror ray would be.
#ifndef RT_RAYS_CL
#define RT_RAYS_CL

#include "kernels/closest_hit.cl"
#include "kernels/hit_surface.cl"

#define RT_QUERY_FIELDS 12
#define RT_ANSWER_FIELDS 16

// Fields are moved as integers, which preserve every bit.
real3 field3(const IndexLanes* fields) {
    return make3(RT_AS_REALS(fields[0].all), RT_AS_REALS(fields[1].all),
                 RT_AS_REALS(fields[2].all));
}

void set_field3(IndexLanes* fields, real3 v) {
    fields[0].all = RT_AS_INDICES(v.x);
    fields[1].all = RT_AS_INDICES(v.y);
    fields[2].all = RT_AS_INDICES(v.z);
}

Ray query_ray(const IndexLanes* fields) {
    Ray ray;
    ray.origin = field3(fields);
    ray.t_max = RT_AS_REALS(fields[3].all);
    ray.dir = field3(fields + 4);
    ray.from = fields[7].all;
    ray.self_hit = RT_AS_REALS(fields[11].all);
    ray.dir_low = make3((Reals)0, (Reals)0, (Reals)0);
    ray.origin_low = ray.dir_low;
    ray.zone = (Reals)0;
    ray.left = ray.left_side = (Indices)0;
    return ray;
}

// The nearest hit of the ray that leaves a surface in the direction dir.
Hit next_hit(const SceneView* scene, const Surface* surface, real3 dir, Indices prim, Mask live) {
    Ray ray = spawn_ray(surface, offset_origin(surface, dir), dir, prim);
    return closest_hit(scene, &ray, live);
}

// Answers the queries of one packet.
void rays_item(__global RayAnswer* answers, __global const RayQuery* queries,
               const SceneView* scene, Index count, Index item) {
    IndexLanes fields[RT_QUERY_FIELDS];
    Index first = item * RT_LANES;
    for (Index i = 0; i < RT_LANES; ++i) {
        Index n = first + i < count ? first + i : count - 1;
        __global const Index* query = (__global const Index*)&queries[n];
        for (int f = 0; f < RT_QUERY_FIELDS; ++f) fields[f].lane[i] = query[f];
    }
    Mask live = (Mask)(RT_LANE_NUMBERS + first < count);
    Ray ray = query_ray(fields);
    real3 next = field3(fields + 8);
    Hit hit = closest_hit(scene, &ray, live);
    IndexLanes out[RT_ANSWER_FIELDS];
    for (int f = 0; f < RT_ANSWER_FIELDS; ++f) out[f].all = (Indices)0;
    out[0].all = RT_AS_INDICES(hit.t);
    out[1].all = RT_AS_INDICES(hit.u);
    out[2].all = RT_AS_INDICES(hit.v);
    out[3].all = hit.prim;
    Mask asks = live & (ray.t_max < (Reals)INFINITY);
    ray.t_max = asks ? ray.t_max : (Reals)-1;
    if (any_lane(ray.t_max > (Reals)0)) {
        Mask blocked = any_hit(scene, &ray, RT_TOUCHES_NO_LIGHT, 0, scene->params.triangle_count);
        out[7].all = blocked ? (Indices)1 : (Indices)0;
    }
    Mask met = live & (hit.prim != RT_NONE);
    out[11].all = (Indices)RT_NONE;
    if (any_lane(met)) {
        Surface surface = surface_at(scene, &ray, &hit, met);
        set_field3(out + 4, surface.point);
        set_field3(out + 8, surface.normal);
        Mask goes_on = met & (dot3(next, next) > (Reals)0);
        if (any_lane(goes_on)) {
            Hit second = next_hit(scene, &surface, next, hit.prim, goes_on);
            out[11].all = goes_on ? second.prim : (Indices)RT_NONE;
            out[12].all = RT_AS_INDICES(second.t);
        }
    }
    for (Index i = 0; i < RT_LANES; ++i) {
        if (first + i >= count) return;
        __global Index* answer = (__global Index*)&answers[first + i];
        for (int f = 0; f < RT_ANSWER_FIELDS; ++f) answer[f] = out[f].lane[i];
    }
}

#endif
