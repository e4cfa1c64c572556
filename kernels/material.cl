// SPDX-License-Identifier: Apache-2.0
//
// The materials of a packet's surfaces.
#ifndef RT_MATERIAL_CL
#define RT_MATERIAL_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// The material of every lane (kernels/shared.h).
typedef struct {
    real3 ambient, diffuse, specular, mirror, transmission;
    Reals shininess, ior;
    Indices two_sided;
} Materials;

Mask is_black(real3 color) {
    return (color.x == (Reals)0) & (color.y == (Reals)0) & (color.z == (Reals)0);
}

// The same material in every lane.
Materials load_material(__global const Material* from) {
    Materials material;
    material.ambient = load3(from->ambient);
    material.diffuse = load3(from->diffuse);
    material.specular = load3(from->specular);
    material.mirror = load3(from->mirror);
    material.transmission = load3(from->transmission);
    material.shininess = (Reals)from->shininess;
    material.ior = (Reals)from->ior;
    material.two_sided = (Indices)from->two_sided;
    return material;
}

Materials select_materials(Mask mask, Materials yes, Materials no) {
    Materials chosen;
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

// The materials of the live lanes (at least one): loads one for all of them, then the others one by
// one for their lanes. Compilers drop what a scene does not use.
Materials materials_of(const SceneView* scene, Indices number, Mask live) {
    Index one = least_lane(live, number);
    Materials material = load_material(&scene->materials[one]);
    for (Mask left = live & (number != one); any_lane(left);) {
        one = least_lane(left, number);
        Mask lanes = left & (number == one);
        left &= !lanes;
        material = select_materials(lanes, load_material(&scene->materials[one]), material);
    }
    return material;
}

#endif
