// SPDX-License-Identifier: Apache-2.0
//
// Rays against the scene: one kind of primitive after the other, through its hierarchy if it has
// one; hits go to kernels/search.cl.
#ifndef RT_CLOSEST_HIT_CL
#define RT_CLOSEST_HIT_CL

#include "kernels/bvh.cl"
#include "kernels/cone.cl"
#include "kernels/search.cl"

void search_spheres(const SceneView* scene, const Ray* ray, Traversal* traversal, Search* search) {
    Index first, end;
    enter_kind(traversal, scene->params.sphere_root, scene->params.sphere_count, scene->spheres,
               sizeof(Sphere));
    while (next_range(traversal, scene->nodes, search->limit, &first, &end)) {
        for (Index prim = first; prim < end; ++prim) {
            __global const Sphere* sphere = &scene->spheres[prim];
            Reals t;
            Mask met = intersect_sphere(ray, sphere, prim, &t);
            if (any_lane(met)) offer_hit(scene, search, met, t, (Reals)0, (Reals)0, prim);
        }
    }
}

void search_cones(const SceneView* scene, const Ray* ray, Traversal* traversal, Search* search) {
    Index first, end;
    enter_kind(traversal, scene->params.cone_root, scene->params.cone_count, scene->cones,
               sizeof(Cone));
    while (next_range(traversal, scene->nodes, search->limit, &first, &end)) {
        for (Index i = first; i < end; ++i) {
            Index prim = scene->params.sphere_count + i;
            Reals t;
            Mask leaving = leaves_cone(ray, &scene->cones[i], prim);
            Mask met = intersect_cone(ray, &scene->cones[i], leaving, &t);
            if (any_lane(met)) offer_hit(scene, search, met, t, (Reals)0, (Reals)0, prim);
        }
    }
}

void search_triangles(const SceneView* scene, const Ray* ray, const RayShear* shear,
                      Traversal* traversal, Search* search) {
    Index first, end;
    enter_kind(traversal, scene->params.triangle_root, scene->params.triangle_count,
               scene->triangles, sizeof(Triangle));
    while (next_range(traversal, scene->nodes, search->limit, &first, &end)) {
        for (Index i = first; i < end; ++i) {
            Reals t, u, v;
            Mask met = intersect_triangle(shear, &scene->triangles[i], &t, &u, &v);
            if (!any_lane(met)) continue;
            Index prim = first_triangle(scene) + i;
            met &= ray->from != prim;
            if (RT_HAS_EYE_ON_SURFACE && scene->triangles[i].plane == (Real)0) {
                met &= ray->from != RT_EYE;
            }
            offer_hit(scene, search, met, t, u, v, prim);
        }
    }
}

void search_all(const SceneView* scene, const Ray* ray, const RayShear* shear, Search* search) {
    Traversal traversal = begin_traversal(ray, search->limit > (Reals)0);
    if (RT_HAS_SPHERES) search_spheres(scene, ray, &traversal, search);
    if (RT_HAS_CONES) search_cones(scene, ray, &traversal, search);
    if (RT_HAS_TRIANGLES) search_triangles(scene, ray, shear, &traversal, search);
}

// The nearest hits of the rays in the live lanes.
Hit closest_hit(const SceneView* scene, const Ray* ray, Mask live) {
    RayShear shear = make_shear(ray, live);
    Search search;
    search.hit.t = live ? (Reals)INFINITY : (Reals)-1;
    search.hit.u = search.hit.v = (Reals)0;
    search.hit.prim = (Indices)RT_NONE;
    search.second = (Reals)INFINITY;
    search.number = (Indices)RT_MAX_INDEX;
    search.limit = search.hit.t;
    search.finds_first = false;
    Mask tied = RT_NO_LANES;
    for (;;) {
        search_all(scene, ray, &shear, &search);
        Reals tie = search.hit.t * RT_TIE;
        if (!search.finds_first) tied = (search.hit.prim != RT_NONE) & (search.second <= tie);
        if (search.finds_first || !any_lane(tied)) break;
        search.limit = tied ? tie : (Reals)-1;
        search.finds_first = true;
    }
    search.hit.tied = tied;
    return search.hit;
}

// Switches off the lanes that are blocked. True when none is left.
bool block(Reals* t_max, Mask blocked) {
    *t_max = blocked ? (Reals)-1 : *t_max;
    return !any_lane(*t_max > (Reals)0);
}

// The functions blocked_by_* switch off the lanes whose rays meet a primitive of the kind in
// (0, *t_max]. True when no lane is left on.

bool blocked_by_spheres(const SceneView* scene, const Ray* ray, Traversal* traversal,
                        Reals* t_max) {
    Index first, end;
    enter_kind(traversal, scene->params.sphere_root, scene->params.sphere_count, scene->spheres,
               sizeof(Sphere));
    while (next_range(traversal, scene->nodes, *t_max, &first, &end)) {
        for (Index prim = first; prim < end; ++prim) {
            __global const Sphere* sphere = &scene->spheres[prim];
            Reals t;
            Mask met = intersect_sphere(ray, sphere, prim, &t);
            if (!any_lane(met)) continue;
            met &= (t > (Reals)0) & (t <= *t_max);
            if (!any_lane(met)) continue;
            if (block(t_max, met & !ends_on_sphere(ray, sphere, t, *t_max))) return true;
        }
    }
    return false;
}

bool blocked_by_cones(const SceneView* scene, const Ray* ray, Traversal* traversal, Reals* t_max) {
    Index first, end;
    enter_kind(traversal, scene->params.cone_root, scene->params.cone_count, scene->cones,
               sizeof(Cone));
    while (next_range(traversal, scene->nodes, *t_max, &first, &end)) {
        for (Index i = first; i < end; ++i) {
            Reals t;
            Mask leaving = ray->from == scene->params.sphere_count + i;
            Mask met = intersect_cone(ray, &scene->cones[i], leaving, &t);
            if (!any_lane(met)) continue;
            if (block(t_max, met & (t > (Reals)0) & (t <= *t_max))) return true;
        }
    }
    return false;
}

// Triangles without a hierarchy come from the light's list of those that can cast a shadow, if it
// has one.
bool blocked_by_triangles(const SceneView* scene, const Ray* ray, Traversal* traversal,
                          Reals* t_max, Index first_caster, Index caster_count) {
    bool is_brute = !RT_HAS_HIERARCHY || scene->params.triangle_root == 0;
    bool has_list = is_brute && caster_count != scene->params.triangle_count;
    if (is_brute && caster_count == 0) return false;
    RayShear shear = make_shear(ray, *t_max > (Reals)0);
    Index first, end;
    enter_kind(traversal, scene->params.triangle_root, caster_count, scene->triangles,
               sizeof(Triangle));
    while (next_range(traversal, scene->nodes, *t_max, &first, &end)) {
        for (Index i = first; i < end; ++i) {
            Index index = has_list ? scene->casters[first_caster + i] : i;
            Reals t, u, v;
            Mask met = intersect_triangle(&shear, &scene->triangles[index], &t, &u, &v);
            if (!any_lane(met)) continue;
            Index prim = first_triangle(scene) + index;
            met &= (t > (Reals)0) & (t <= *t_max) & (ray->from != prim);
            if (any_lane(met) && block(t_max, met)) return true;
        }
    }
    return false;
}

// Whether anything lies on the rays in (0, t_max]. Without a hierarchy, tests caster_count
// triangles of the caster list from first_caster on, or all triangles if that is their number.
Mask any_hit(const SceneView* scene, const Ray* ray, Index first_caster, Index caster_count) {
    Reals t_max = ray->t_max;
    Traversal traversal = begin_traversal(ray, t_max > (Reals)0);
    bool is_done = RT_HAS_SPHERES && blocked_by_spheres(scene, ray, &traversal, &t_max);
    is_done = is_done || (RT_HAS_CONES && blocked_by_cones(scene, ray, &traversal, &t_max));
    if (RT_HAS_TRIANGLES && !is_done) {
        blocked_by_triangles(scene, ray, &traversal, &t_max, first_caster, caster_count);
    }
    return (ray->t_max > (Reals)0) & (t_max < (Reals)0);
}

#endif
