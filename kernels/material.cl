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

// The same material in every lane.
Finish load_finish(__global const Material* material) {
    Finish finish;
    finish.ambient = load3(material->ambient);
    finish.diffuse = load3(material->diffuse);
    finish.specular = load3(material->specular);
    finish.mirror = load3(material->mirror);
    finish.transmission = load3(material->transmission);
    finish.shininess = (Reals)material->shininess;
    finish.ior = (Reals)material->ior;
    finish.two_sided = (Indices)material->two_sided;
    return finish;
}

Finish select_finish(Mask mask, Finish yes, Finish no) {
    Finish chosen;
    chosen.ambient = select3(mask, yes.ambient, no.ambient);
    chosen.diffuse = select3(mask, yes.diffuse, no.diffuse);
    chosen.specular = select3(mask, yes.specular, no.specular);
    chosen.mirror = select3(mask, yes.mirror, no.mirror);
    chosen.transmission = select3(mask, yes.transmission, no.transmission);
    chosen.shininess = mask ? yes.shininess : no.shininess;
    chosen.ior = mask ? yes.ior : no.ior;
    chosen.two_sided = mask ? yes.two_sided : no.two_sided;
    return chosen;
}

// The finishes of the live lanes, of which there is one at least: the first material for all, then
// the others one by one for the lanes that wear them. Compilers drop what a scene does not use.
Finish finish_of(const SceneView* scene, Indices material, Mask live) {
    Index one = least_lane(live, material);
    Finish finish = load_finish(&scene->materials[one]);
    for (Mask left = live & (material != one); any_lane(left);) {
        one = least_lane(left, material);
        Mask lanes = left & (material == one);
        left &= !lanes;
        finish = select_finish(lanes, load_finish(&scene->materials[one]), finish);
    }
    return finish;
}

#endif
