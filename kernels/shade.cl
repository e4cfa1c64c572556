// SPDX-License-Identifier: Apache-2.0
//
// Local light at a point (Phong 1975 with Blinn's half vector, 1977; shadows as in Whitted 1980):
//   ka Ia + sum over the lights that reach it of Ii (kd max(0, n.l) + ks max(0, n.h)^p).
// A light reaches a point if it lies in front of both the shading and the geometric normal's plane
// and nothing lies between. Shadow rays end 16 half-ulps before the light.
#ifndef RT_SHADE_CL
#define RT_SHADE_CL

#include "kernels/closest_hit.cl"
#include "kernels/hit_surface.cl"
#include "kernels/material.cl"
#include "kernels/power.cl"
#include "kernels/signature.cl"

#ifndef RT_EXPLAIN  // kernels/native/explain.cl reports path events with it
#define RT_EXPLAIN(live, what, index, bounce, distance, weight, point, normal, color)
#endif

// max(0, n.h)^p with h halfway between the unit directions to the light and to the eye.
Reals specular_lobe(real3 normal, real3 to_light, real3 to_eye, Reals shininess) {
    real3 sum = add3(to_light, to_eye);
    Reals along = dot3(normal, sum);
    real3 across = add_scaled(sum, -along, normal);
    return blinn_lobe(along, dot3(across, across), dot3(sum, sum), shininess);
}

// The contribution of light `number` in the live lanes; `origin` is where shadow rays start.
real3 light_contribution(const SceneView* scene, const Surface* surface, const Materials* material,
                         Index number, real3 origin, real3 to_eye, Indices prim, Mask live,
                         PacketCounts* counts) {
    __global const Light* light = &scene->lights[number];
    const real3 none = make3((Reals)0, (Reals)0, (Reals)0);
    real3 to_light = sub3(load3(light->position), origin);
    Mask lit = live & (dot3(surface->geometric, to_light) > (Reals)0);
    if (!any_lane(lit)) return none;
    Reals distance = length3(to_light);
    real3 dir = scale3((Reals)1 / distance, to_light);
    Ray shadow = spawn_ray(surface, origin, dir, prim);
    Reals cosine = dot3(surface->normal, shadow.dir);
    lit &= cosine > (Reals)0;
    if (RT_HAS(VERTEX_NORMALS) && !any_lane(lit)) return none;
    Reals end = distance * (Reals)((Real)1 - (Real)16 * (Real)RT_ROUNDOFF);
    shadow.t_max = lit ? end : (Reals)-1;
    counts->shadow += lit & 1;
    RT_EXPLAIN(lit, RT_EVENT_SHADOW, number, 0, distance, none, origin, dir, none);
    Index last = RT_TOUCHES_LIGHTS - 1;
    Index place = RT_TOUCHES_FIRST_LIGHT + 2 * (number < last ? number : last);
    lit &= !any_hit(scene, &shadow, place, light->first_caster, light->caster_count);
    if (!any_lane(lit)) return none;
    sign_lanes(scene, counts, lit, (Indices)(number + 1));
    real3 reflected = scale3(cosine, material->diffuse);
    if (any_lane(lit & !is_black(material->specular))) {  // elsewhere it adds 0
        Reals lobe = specular_lobe(surface->normal, shadow.dir, to_eye, material->shininess);
        reflected = add_scaled(reflected, lobe, material->specular);
    }
    real3 added = select3(lit, mul3(load3(light->intensity), reflected), none);
    RT_EXPLAIN(lit, RT_EVENT_LIT, number, 0, distance, none, origin, dir, added);
    return added;
}

real3 shade(const SceneView* scene, const Surface* surface, const Materials* material, real3 to_eye,
            Indices prim, Mask live, PacketCounts* counts) {
    real3 color = mul3(material->ambient, load3(scene->params.ambient_light));
    if (RT_HAS(LIGHTS)) {
        real3 origin = offset_origin(surface, surface->geometric);
        for (Index i = 0; i < scene->params.light_count; ++i) {
            color = add3(color, light_contribution(scene, surface, material, i, origin, to_eye,
                                                   prim, live, counts));
        }
    }
    return color;
}

#endif
