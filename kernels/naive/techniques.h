// SPDX-License-Identifier: Apache-2.0
//
// Which techniques a naive program does without. Each switch is 0 unless the build says
// -DRT_NAIVE_...=1 (host/render/techniques.h).
#ifndef RT_NAIVE_TECHNIQUES_H
#define RT_NAIVE_TECHNIQUES_H

#ifndef RT_NAIVE_SPHERES
#define RT_NAIVE_SPHERES 0
#endif
#ifndef RT_NAIVE_TRIANGLES
#define RT_NAIVE_TRIANGLES 0
#endif
#ifndef RT_NAIVE_BOXES
#define RT_NAIVE_BOXES 0
#endif
#ifndef RT_NAIVE_TIES
#define RT_NAIVE_TIES 0
#endif
#ifndef RT_NAIVE_POINTS
#define RT_NAIVE_POINTS 0
#endif
#ifndef RT_NAIVE_OFFSETS
#define RT_NAIVE_OFFSETS 0
#endif
#ifndef RT_NAIVE_LOBE
#define RT_NAIVE_LOBE 0
#endif

#endif
