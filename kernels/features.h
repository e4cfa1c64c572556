// SPDX-License-Identifier: Apache-2.0
//
// The features a scene can need, and the entry points a renderer can launch. The host decides
// (host/flatten/flat_scene.cpp), from the flat scene alone; a kernel built without options renders
// everything. Used as `if (RT_HAS(X))` in plain code, so every build type-checks every branch; but
// each entry point holds the whole tracer, so those that are not launched are not even compiled.
#ifndef RT_FEATURES_H
#define RT_FEATURES_H

// In the order of host/flatten/features.h.
#define RT_SPHERES 0x1
#define RT_HUGE_SPHERES 0x2
#define RT_EYE_ON_SURFACE 0x4
#define RT_CONES 0x8
#define RT_TRIANGLES 0x10
#define RT_VERTEX_NORMALS 0x20
#define RT_HIERARCHY 0x40
#define RT_LIGHTS 0x80
#define RT_MIRRORS 0x100
#define RT_GLASS 0x200
#define RT_SOBOL 0x400
#define RT_FILTERS 0x800
#define RT_EDGES 0x1000

#ifndef RT_FEATURE_BITS
#define RT_FEATURE_BITS 0x1fff
#endif
#ifndef RT_SWITCHES  // a variable in tests/switchable_features.h
#define RT_SWITCHES (RT_FEATURE_BITS)
#endif
#define RT_HAS(feature) ((RT_SWITCHES & RT_##feature) != 0)

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
#define RT_RENDERS_EDGES RT_HAS(EDGES)
#endif
#ifndef RT_TRACES_RAYS
#define RT_TRACES_RAYS 1
#endif

#endif
