// SPDX-License-Identifier: Apache-2.0
//
// The features a scene can need, and the entry points a renderer can launch. Each switch is 1
// unless the build says -DRT_HAS_...=0, so a kernel built without options renders everything. The
// host decides (host/flatten/flat_scene.cpp), from the flat scene alone. Used as `if (RT_HAS_X)` in
// plain code, so every build type-checks every branch; but each entry point holds the whole tracer,
// so those that are not launched are not even compiled.
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
#ifndef RT_HAS_SOBOL
#define RT_HAS_SOBOL 1
#endif
#ifndef RT_HAS_FILTERS
#define RT_HAS_FILTERS 1
#endif
#ifndef RT_HAS_EDGES
#define RT_HAS_EDGES 1
#endif

// The switches as bits, in the order of host/flatten/features.h.
#ifndef RT_FEATURE_BITS
#define RT_FEATURE_BITS                                                                           \
    (RT_HAS_SPHERES | RT_HAS_HUGE_SPHERES << 1 | RT_HAS_EYE_ON_SURFACE << 2 | RT_HAS_CONES << 3 | \
     RT_HAS_TRIANGLES << 4 | RT_HAS_VERTEX_NORMALS << 5 | RT_HAS_HIERARCHY << 6 |                 \
     RT_HAS_LIGHTS << 7 | RT_HAS_MIRRORS << 8 | RT_HAS_GLASS << 9 | RT_HAS_SOBOL << 10 |          \
     RT_HAS_FILTERS << 11 | RT_HAS_EDGES << 12)
#endif

// Samples per pixel, if compiled in (then a packet holds them all); else 0.
#ifndef RT_SAMPLES
#define RT_SAMPLES 0
#endif

#ifndef RT_RENDERS_PIXELS
#define RT_RENDERS_PIXELS 1
#endif
#ifndef RT_RENDERS_SAMPLES
#define RT_RENDERS_SAMPLES 1
#endif
#ifndef RT_RENDERS_ADAPTIVE
#define RT_RENDERS_ADAPTIVE (RT_SAMPLES == 0)
#endif
#ifndef RT_RENDERS_EDGES
#define RT_RENDERS_EDGES RT_HAS_EDGES
#endif
#ifndef RT_TRACES_RAYS
#define RT_TRACES_RAYS 1
#endif

#endif
