// SPDX-License-Identifier: Apache-2.0
//
// Events of a path, from kernels compiled to explain a pixel (explain.cl); one struct for the
// kernels and the host. Includes nothing.
#ifndef RT_PATH_EVENT_H
#define RT_PATH_EVENT_H

enum {
    RT_EVENT_SAMPLE,     // an eye ray starts: index is the sample's number
    RT_EVENT_MIRROR,     // a mirror ray starts
    RT_EVENT_REFRACTED,  // a refracted ray starts
    RT_EVENT_MISS,       // the ray meets nothing: color is the background's
    RT_EVENT_SHADOW,     // light number index may reach the surface: a shadow ray is traced
    RT_EVENT_LIT,        // it does: color is its contribution
    RT_EVENT_HIT  // the ray hit primitive number index; color is all local light. After its lights'
                  // events
};

typedef struct {
    long what;   // RT_EVENT_..
    long index;  // of a sample, light or primitive
    long bounce;
    double distance;   // along the ray to the hit
    double weight[3];  // throughput of the ray
    double point[3];   // ray origin, or surface point
    double normal[3];  // surface normal, or ray direction
    double color[3];
} PathEvent;

#endif
