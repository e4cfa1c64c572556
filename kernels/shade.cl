// SPDX-License-Identifier: Apache-2.0
//
// Local light at a point (Phong 1975 with Blinn's half vector, 1977; shadows as in Whitted 1980):
//   ka Ia + sum over the lights that reach it of Ii (kd max(0, n.l) + ks max(0, n.h)^p).
// A light reaches a point when it lies on the front of both the shading and the geometric normal
// and nothing lies between. Shadow rays end 16 half-ulps before the light.
#ifndef RT_SHADE_CL
#define RT_SHADE_CL

#include "kernels/closest_hit.cl"
#include "kernels/power.cl"
#include "kernels/surface.cl"

bool is_black(real3 color) {
    return color.x == (Real)0 && color.y == (Real)0 && color.z == (Real)0;
}

// max(0, n.h)^p with h halfway between the unit directions to the light and to the eye.
Real specular_lobe(real3 normal, real3 to_light, real3 to_eye, Real shininess) {
    real3 sum = add3(to_light, to_eye);
    Real squared = dot3(sum, sum);
    if (!(squared > (Real)0)) return (Real)0;
    real3 half_vector = scale3((Real)1 / sqrt(squared), sum);
    real3 gap = sub3(normal, half_vector);
    return blinn_lobe(dot3(normal, half_vector), (Real)0.5 * dot3(gap, gap), shininess);
}

// What one light adds at the surface; `origin` is where shadow rays start.
real3 light_contribution(const SceneView* scene, const Surface* surface,
                         __global const Material* material, __global const Light* light,
                         real3 origin, real3 to_eye, Index prim, RayCounts* counts) {
    const real3 none = {0, 0, 0};
    real3 to_light = sub3(load3(light->position), origin);
    if (!(dot3(surface->geometric, to_light) > (Real)0)) return none;
    Real distance = length3(to_light);
    Ray shadow;
    shadow.origin = origin;
    shadow.dir = scale3((Real)1 / distance, to_light);
    shadow.t_max = distance * ((Real)1 - (Real)16 * (Real)RT_ROUNDOFF);
    shadow.from = prim;
    Real cosine = dot3(surface->normal, shadow.dir);
    if (!(cosine > (Real)0)) return none;
    counts->shadow += 1;
    if (any_hit(scene, &shadow)) return none;
    real3 reflected = scale3(cosine, load3(material->diffuse));
    real3 specular = load3(material->specular);
    if (!is_black(specular)) {
        Real lobe = specular_lobe(surface->normal, shadow.dir, to_eye, material->shininess);
        reflected = add_scaled(reflected, lobe, specular);
    }
    return mul3(load3(light->intensity), reflected);
}

real3 shade(const SceneView* scene, const Surface* surface, __global const Material* material,
            real3 to_eye, Index prim, RayCounts* counts) {
    real3 color = mul3(load3(material->ambient), load3(scene->frame.ambient_light));
    if (RT_HAS_LIGHTS) {
        real3 origin = offset_origin(surface, surface->geometric);
        for (Index i = 0; i < scene->frame.light_count; ++i) {
            color = add3(color, light_contribution(scene, surface, material, &scene->lights[i],
                                                   origin, to_eye, prim, counts));
        }
    }
    return color;
}

#endif
