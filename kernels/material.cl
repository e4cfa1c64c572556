// SPDX-License-Identifier: Apache-2.0
//
// What the surfaces of a packet are made of.
#ifndef RT_MATERIAL_CL
#define RT_MATERIAL_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// The material of every lane (kernels/shared.h).
typedef struct {
    real3 ambient, diffuse, specular, mirror, transmission;
    Reals shininess, ior;
    Indices two_sided;
} Finish;

Mask is_black(real3 color) {
    return (color.x == (Reals)0) & (color.y == (Reals)0) & (color.z == (Reals)0);
}

// The finishes of the live lanes, of which there is one at least: the first material for all, then
// one after the other for the lanes that wear it.
Finish finish_of(const SceneView* scene, Indices material, Mask live) {
    Index one = least_lane(live, material);
    __global const Material* first = &scene->materials[one];
    Finish finish = {load3(first->ambient), load3(first->diffuse),      load3(first->specular),
                     load3(first->mirror),  load3(first->transmission), (Reals)first->shininess,
                     (Reals)first->ior,     (Indices)first->two_sided};
    for (Mask left = live & (material != one); any_lane(left);) {
        one = least_lane(left, material);
        Mask lanes = left & (material == one);
        left &= !lanes;
        __global const Material* worn = &scene->materials[one];
        finish.ambient = select3(lanes, load3(worn->ambient), finish.ambient);
        if (RT_HAS_LIGHTS) {
            finish.diffuse = select3(lanes, load3(worn->diffuse), finish.diffuse);
            finish.specular = select3(lanes, load3(worn->specular), finish.specular);
            finish.shininess = lanes ? (Reals)worn->shininess : finish.shininess;
        }
        if (RT_HAS_MIRRORS) finish.mirror = select3(lanes, load3(worn->mirror), finish.mirror);
        if (RT_HAS_GLASS) {
            finish.transmission = select3(lanes, load3(worn->transmission), finish.transmission);
            finish.ior = lanes ? (Reals)worn->ior : finish.ior;
        }
        finish.two_sided = lanes ? (Indices)worn->two_sided : finish.two_sided;
    }
    return finish;
}

#endif
