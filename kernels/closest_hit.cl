// SPDX-License-Identifier: Apache-2.0
//
// One ray against the scene, every primitive in turn.
//
// Ties: surfaces within 32 half-ulps of the nearest one are one surface, and the lowest index among
// them is hit. That set does not depend on the order of the tests, so neither does the picture: a
// first pass finds the two smallest distances, and only when they lie that close a second pass
// looks for the lowest index. Rays through the shared edges of the paper's box do it (they project
// onto the picture's diagonals); hardly any other ray does.
#ifndef RT_CLOSEST_HIT_CL
#define RT_CLOSEST_HIT_CL

#include "kernels/intersect.cl"

#define RT_TIE ((Real)1 + (Real)32 * (Real)RT_ROUNDOFF)

// Distance to primitive `prim`, or -1 (or NaN) where it is missed.
Real intersect_primitive(const SceneView* scene, const Ray* ray, const RayShear* shear, Index prim,
                         Real* u, Real* v) {
    if (RT_HAS_SPHERES && prim < scene->frame.sphere_count) {
        __global const Sphere* sphere = &scene->spheres[prim];
        return intersect_sphere(ray, load3(sphere->center), sphere->radius, prim == ray->from);
    }
    if (RT_HAS_TRIANGLES && prim != ray->from) {
        Index index = prim - scene->frame.sphere_count;
        return intersect_triangle(shear, &scene->triangles[index], u, v);
    }
    return (Real)-1;
}

// The lowest-numbered primitive hit no further away than t_max; there is one.
Hit first_listed_hit(const SceneView* scene, const Ray* ray, const RayShear* shear, Real t_max) {
    Index count = scene->frame.sphere_count + scene->frame.triangle_count;
    Hit hit = {0, 0, 0, RT_NONE, 1};
    for (Index prim = 0; prim < count; ++prim) {
        hit.t = intersect_primitive(scene, ray, shear, prim, &hit.u, &hit.v);
        if (hit.t > (Real)0 && hit.t <= t_max) {
            hit.prim = prim;
            return hit;
        }
    }
    return hit;
}

Hit closest_hit(const SceneView* scene, const Ray* ray) {
    Index count = scene->frame.sphere_count + scene->frame.triangle_count;
    RayShear shear = make_shear(ray);
    Hit best = {INFINITY, 0, 0, RT_NONE, 0};
    Real second = INFINITY;
    for (Index prim = 0; prim < count; ++prim) {
        Real u = 0, v = 0;
        Real t = intersect_primitive(scene, ray, &shear, prim, &u, &v);
        if (t > (Real)0 && t < second) {
            if (t < best.t) {
                second = best.t;
                best.t = t;
                best.u = u;
                best.v = v;
                best.prim = prim;
            } else {
                second = t;
            }
        }
    }
    Real tie = best.t * RT_TIE;
    if (best.prim != RT_NONE && second <= tie) return first_listed_hit(scene, ray, &shear, tie);
    return best;
}

// Whether anything lies on the ray in (0, t_max].
bool any_hit(const SceneView* scene, const Ray* ray) {
    Index count = scene->frame.sphere_count + scene->frame.triangle_count;
    RayShear shear = make_shear(ray);
    for (Index prim = 0; prim < count; ++prim) {
        Real u, v;
        Real t = intersect_primitive(scene, ray, &shear, prim, &u, &v);
        if (t > (Real)0 && t <= ray->t_max) return true;
    }
    return false;
}

#endif
