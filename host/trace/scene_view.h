// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flatten/flat_types.h"
#include "host/trace/ray_counts.h"

// Twin of kernels/scene_view.h.
namespace rt::trace {

template <typename T>
struct SceneView {
    const typename Flat<T>::Sphere* spheres;
    const typename Flat<T>::Triangle* triangles;
    const typename Flat<T>::VertexNormals* vertex_normals;
    const typename Flat<T>::Material* materials;
    const typename Flat<T>::Light* lights;
    typename Flat<T>::Frame frame;
};

/// Primitives are numbered spheres first, then triangles.
template <typename T>
struct Ray {
    Vec3<T> origin;
    Vec3<T> dir;                   ///< unit
    T t_max;                       ///< hits lie in (0, t_max]
    typename Flat<T>::Index from;  ///< the primitive the origin lies on, or none
};

template <typename T>
struct Hit {
    T t, u, v;                     ///< u, v: weights of a triangle's second and third vertex
    typename Flat<T>::Index prim;  ///< none: a miss
    typename Flat<T>::Index tied;  ///< 1 where several surfaces meet within rounding
};

}  // namespace rt::trace
