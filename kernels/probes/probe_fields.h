// SPDX-License-Identifier: Apache-2.0
//
// The members of the structs passed between the kernel tests and the probes besides those of
// kernels/shared.h, X(kind, name): in OpenCL C in probe_structs.h, in C++ in probe_types.h.
#ifndef RT_PROBE_FIELDS_H
#define RT_PROBE_FIELDS_H

#define PROBE_RAY(X)   \
    X(REAL3, origin)   \
    X(REALS, t_max)    \
    X(REAL3, dir)      \
    X(INDICES, from)   \
    X(REALS, self_hit) \
    X(REAL3, dir_low)  \
    X(REAL3, origin_low)

#define PROBE_SURFACE(X)      \
    X(REAL3, point)           \
    X(REALS, offset)          \
    X(REAL3, normal)          \
    X(INDICES, material)      \
    X(REAL3, geometric)       \
    X(REALS, signed_diameter) \
    X(REAL3, point_low)

#define PROBE_HIT(X) \
    X(REALS, t)      \
    X(REALS, u)      \
    X(REALS, v)      \
    X(INDICES, prim) \
    X(MASK, tied)    \
    X(REALS, behind)

#endif
