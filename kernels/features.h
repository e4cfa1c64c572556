// SPDX-License-Identifier: Apache-2.0
//
// What a scene can need. Each switch is 1 unless the build says -DRT_HAS_...=0, so a kernel built
// without options renders everything. The host decides (host/flatten/flat_scene.cpp), from the flat
// scene alone. Used as `if (RT_HAS_X)` in plain code, so every build type-checks every branch.
#ifndef RT_FEATURES_H
#define RT_FEATURES_H

#ifndef RT_HAS_SPHERES
#define RT_HAS_SPHERES 1
#endif
#ifndef RT_HAS_HUGE_SPHERES
#define RT_HAS_HUGE_SPHERES 1
#endif
#ifndef RT_HAS_EYE_ON_SURFACE
#define RT_HAS_EYE_ON_SURFACE 1
#endif
#ifndef RT_HAS_CONES
#define RT_HAS_CONES 1
#endif
#ifndef RT_HAS_TRIANGLES
#define RT_HAS_TRIANGLES 1
#endif
#ifndef RT_HAS_VERTEX_NORMALS
#define RT_HAS_VERTEX_NORMALS 1
#endif
#ifndef RT_HAS_HIERARCHY
#define RT_HAS_HIERARCHY 1
#endif
#ifndef RT_HAS_LIGHTS
#define RT_HAS_LIGHTS 1
#endif
#ifndef RT_HAS_MIRRORS
#define RT_HAS_MIRRORS 1
#endif
#ifndef RT_HAS_GLASS
#define RT_HAS_GLASS 1
#endif

#endif
