// SPDX-License-Identifier: Apache-2.0
//
// What happens to a path, where kernels are compiled to explain a pixel (explain.cl); one
// struct for the kernels and the host. Includes nothing.
#ifndef RT_PATH_EVENT_H
#define RT_PATH_EVENT_H

enum {
    RT_EVENT_SAMPLE,     // an eye ray starts: index is the sample's number
    RT_EVENT_MIRROR,     // a mirror ray starts
    RT_EVENT_REFRACTED,  // a refracted ray starts
    RT_EVENT_MISS,       // the ray meets nothing: color is the background's
    RT_EVENT_SHADOW,     // light number index may reach the surface: a shadow ray is traced
    RT_EVENT_LIT,        // and it does: color is what it adds
    RT_EVENT_HIT  // the ray met primitive number index; color is all local light there. Comes
                  // after the events of its lights
};

typedef struct {
    long what;   // RT_EVENT_..
    long index;  // of a sample, light or primitive
    long bounce;
    double distance;   // along the ray to the hit
    double weight[3];  // what the ray counts
    double point[3];   // where the ray starts, or the surface is
    double normal[3];  // or the direction of the ray
    double color[3];
} PathEvent;

#endif
