// SPDX-License-Identifier: Apache-2.0
//
// Rays against the scene: one kind of primitive after the other, through its hierarchy if it has
// one; hits go to kernels/search.cl.
#ifndef RT_CLOSEST_HIT_CL
#define RT_CLOSEST_HIT_CL

#include "kernels/bvh.cl"
#include "kernels/cone.cl"
#include "kernels/hit_surface.cl"
#include "kernels/search.cl"

#ifndef RT_SEARCH_OUT_OF_LINE  // kernels/probes/probes.cl
#define RT_SEARCH_OUT_OF_LINE
#endif

// A surface's material and the side that the ray meets: one number.
Indices side_of(const Surface* surface, real3 dir) {
    Mask inside = dot3(surface->geometric, dir) > (Reals)0;
    return surface->material * 2 + (inside & 1);
}

bool is_glass(const SceneView* scene, Index material) {
    Packed3 through = scene->materials[material].transmission;
    return RT_HAS(GLASS) && (through.x != (Real)0 || through.y != (Real)0 || through.z != (Real)0);
}

// offer_hit, but for surfaces in the rays' zones that they have crossed: in the lanes returned.
// Refracted rays start up to twice the surface's offset behind a face of glass: other surfaces
// there tie. (Spheres meet others in points.)
Mask offer_uncrossed(const SceneView* scene, const Ray* ray, Search* search, Mask met, Reals t,
                     Reals u, Reals v, Index prim, bool is_glass_face) {
    Mask crossed = RT_NO_LANES;
    Reals behind = (Reals)0;
    if (RT_HAS(GLASS)) {
        Mask zoned = met & (t > (Reals)0) & (t <= ray->zone);
        Mask nearest = is_glass_face ? met & (t > (Reals)0) & (t <= search->hit.t) : RT_NO_LANES;
        if (any_lane(zoned | nearest)) {
            Hit hit = {t, u, v, (Indices)prim, RT_NO_LANES, (Reals)0};
            Surface surface = primitive_surface(scene, ray, &hit, prim);
            if (any_lane(zoned)) {
                crossed = (Indices)scene_number(scene, prim) < ray->left;
                crossed |= side_of(&surface, ray->dir) == ray->left_side;
                crossed &= zoned;
            }
            Reals sine = max_of(fabs(dot3(surface.geometric, ray->dir)), (Reals)RT_SHARPEST);
            if (is_glass_face) behind = (Reals)2 * surface.offset / sine;
        }
    }
    offer_hit(scene, search, met & !crossed, t, u, v, behind, prim);
    return crossed;
}

// offer_uncrossed for a sphere or cone that is met at t and, if that is farther, left at `far`.
void offer_curved(const SceneView* scene, const Ray* ray, Search* search, Mask met, Reals t,
                  Reals far, Index prim, bool is_glass_face) {
    const Reals none = (Reals)0;
    Mask crossed = offer_uncrossed(scene, ray, search, met, t, none, none, prim, is_glass_face);
    crossed &= far > t;
    if (RT_HAS(GLASS) && any_lane(crossed)) {
        offer_uncrossed(scene, ray, search, crossed, far, none, none, prim, is_glass_face);
    }
}

void search_spheres(const SceneView* scene, const Ray* ray, Traversal* traversal, Search* search) {
    Index first, end;
    enter_kind(traversal, scene->params.sphere_root, scene->params.sphere_count, scene->spheres,
               sizeof(Sphere));
    while (next_range(traversal, scene->nodes, search->limit, &first, &end)) {
        for (Index prim = first; prim < end; ++prim) {
            __global const Sphere* sphere = &scene->spheres[prim];
            Reals t;
            Mask met = intersect_sphere(ray, sphere, prim, &t);
            if (any_lane(met)) {
                Reals middle = dot3(sub3(load3(sphere->center), ray->origin), ray->dir);
                offer_curved(scene, ray, search, met, t, (Reals)2 * middle - t, prim, false);
            }
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
            Reals t, far;
            Mask leaving = leaves_cone(ray, &scene->cones[i], prim);
            Mask met = intersect_cone(ray, &scene->cones[i], leaving, &t, &far);
            if (!any_lane(met)) continue;
            offer_curved(scene, ray, search, met, t, far, prim,
                         is_glass(scene, scene->cones[i].material));
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
            if (RT_HAS(EYE_ON_SURFACE) && scene->triangles[i].plane == (Real)0) {
                met &= ray->from != RT_EYE;
            }
            offer_uncrossed(scene, ray, search, met, t, u, v, prim,
                            is_glass(scene, scene->triangles[i].material));
        }
    }
}

void search_all(const SceneView* scene, const Ray* ray, const RayShear* shear, Search* search) {
    Traversal traversal = begin_traversal(ray, search->limit > (Reals)0);
    if (RT_HAS(SPHERES)) search_spheres(scene, ray, &traversal, search);
    if (RT_HAS(CONES)) search_cones(scene, ray, &traversal, search);
    if (RT_HAS(TRIANGLES)) search_triangles(scene, ray, shear, &traversal, search);
}

// The nearest hits of the rays in the live lanes.
RT_SEARCH_OUT_OF_LINE Hit closest_hit(const SceneView* scene, const Ray* ray, Mask live) {
    RayShear shear = make_shear(ray, live);
    Search search;
    search.hit.t = live ? (Reals)INFINITY : (Reals)-1;
    search.hit.u = search.hit.v = (Reals)0;
    search.hit.prim = (Indices)RT_NONE;
    search.second = (Reals)INFINITY;
    search.number = (Indices)RT_MAX_INDEX;
    search.limit = search.hit.t;
    search.slack = RT_TIE * length3(ray->origin);
    search.finds_first = false;
    search.hit.behind = (Reals)0;
    Mask tied = RT_NO_LANES;
    for (;;) {
        search_all(scene, ray, &shear, &search);
        Reals tie = end_of_tie(&search, search.hit.t);
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

bool blocked_by_spheres(const SceneView* scene, const Ray* ray, Index light, Traversal* traversal,
                        Reals* t_max) {
    Index first, end;
    enter_kind(traversal, scene->params.sphere_root, scene->params.sphere_count, scene->spheres,
               sizeof(Sphere));
    while (next_range(traversal, scene->nodes, *t_max, &first, &end)) {
        for (Index prim = first; prim < end; ++prim) {
            __global const Sphere* sphere = &scene->spheres[prim];
            Reals t;
            Mask met = intersect_sphere(ray, sphere, prim, &t);
            Index side = light_side(sphere->touches, light);
            if (side == 0 && !any_lane(met)) continue;
            met = side == 0 ? met & (t > (Reals)0) & (t <= *t_max)
                            : meets_sphere_before(ray, sphere, met, t, *t_max, side);
            if (any_lane(met) && block(t_max, met)) return true;
        }
    }
    return false;
}

bool blocked_by_cones(const SceneView* scene, const Ray* ray, Index light, Traversal* traversal,
                      Reals* t_max) {
    Index first, end;
    enter_kind(traversal, scene->params.cone_root, scene->params.cone_count, scene->cones,
               sizeof(Cone));
    while (next_range(traversal, scene->nodes, *t_max, &first, &end)) {
        for (Index i = first; i < end; ++i) {
            Mask leaving = ray->from == scene->params.sphere_count + i;
            Mask met = meets_cone_before(ray, &scene->cones[i], leaving, *t_max, light);
            if (any_lane(met) && block(t_max, met)) return true;
        }
    }
    return false;
}

// Triangles without a hierarchy come from the light's list of those that can cast a shadow, if it
// has one.
bool blocked_by_triangles(const SceneView* scene, const Ray* ray, Traversal* traversal,
                          Reals* t_max, Index first_caster, Index caster_count) {
    bool is_brute = !RT_HAS(HIERARCHY) || scene->params.triangle_root == 0;
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

// Whether anything lies on the rays in (0, t_max], towards the light with place `light` in the bits
// of Sphere::touches. Without a hierarchy, tests caster_count triangles of the caster list from
// first_caster on, or all triangles if that is their number.
RT_SEARCH_OUT_OF_LINE Mask any_hit(const SceneView* scene, const Ray* ray, Index light,
                                   Index first_caster, Index caster_count) {
    Reals t_max = ray->t_max;
    Traversal traversal = begin_traversal(ray, t_max > (Reals)0);
    bool is_done = RT_HAS(SPHERES) && blocked_by_spheres(scene, ray, light, &traversal, &t_max);
    is_done = is_done || (RT_HAS(CONES) && blocked_by_cones(scene, ray, light, &traversal, &t_max));
    if (RT_HAS(TRIANGLES) && !is_done) {
        blocked_by_triangles(scene, ray, &traversal, &t_max, first_caster, caster_count);
    }
    return (ray->t_max > (Reals)0) & (t_max < (Reals)0);
}

#endif
