// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flatten/flat_scene.h"
#include "host/flatten/flat_types.h"
#include "host/render/ray_counts.h"

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
    const typename Flat<T>::Cone* cones = nullptr;
    const typename Flat<T>::BvhNode* nodes = nullptr;
    const typename Flat<T>::Index* order = nullptr;  ///< null: primitives are in the order listed
    const typename Flat<T>::Index* casters = nullptr;
};

/// The scene must outlive the view.
template <typename T>
SceneView<T> view_of(const FlatScene<T>& scene) {
    return {scene.spheres.data(),
            scene.triangles.data(),
            scene.vertex_normals.data(),
            scene.materials.data(),
            scene.lights.data(),
            scene.frame,
            scene.cones.data(),
            scene.nodes.data(),
            scene.order.empty() ? nullptr : scene.order.data(),
            scene.casters.data()};
}

/// Primitives are numbered spheres first, then cones, then triangles.
template <typename Frame>
auto first_triangle(const Frame& frame) {
    return frame.sphere_count + frame.cone_count;
}

template <typename T>
struct Ray {
    Vec3<T> origin;
    Vec3<T> dir;                      ///< unit
    T t_max;                          ///< hits lie in (0, t_max]
    typename Flat<T>::Index from;     ///< the primitive the origin lies on, or none
    T chord = 0;                      ///< from a sphere: distance to where it leaves; a cone: -2 b
    Vec3<T> dir_low = Vec3<T>(0);     ///< of eye rays: what rounding took from dir
    Vec3<T> origin_low = Vec3<T>(0);  ///< of others: from the origin to the point left
};

template <typename T>
struct Hit {
    T t, u, v;                     ///< u, v: weights of a triangle's second and third vertex
    typename Flat<T>::Index prim;  ///< none: a miss
    typename Flat<T>::Index tied;  ///< 1 where several surfaces meet within rounding
};

}  // namespace rt::trace
