// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "host/flatten/bvh.h"
#include "host/flatten/flat_types.h"
#include "host/flatten/triangle_list.h"
#include "host/flatten/view_frame.h"
#include "host/scene/scene.h"

// Primitives one by one, from the author's to the renderer's frame. All arithmetic is in double;
// rounding to T comes last.
// Boxes that no ray that hits their contents can miss, in the arithmetic of kernels/: every
// coordinate is moved out by box_slack half-ulps of the box's largest one. The triangle test works
// on vertices rounded in the ray's frame, at most 8 half-ulps of |vertex| + |origin| off, and t is
// rounded once more; the origin's part is added to the ray (kernels/bvh.cl).
namespace rt {

/// The part of v that pack() loses by rounding; 0 in double.
template <typename T>
typename Flat<T>::Packed3 pack_low(const glm::dvec3& v) {
    const auto high = pack<T>(v);
    return pack<T>(v - glm::dvec3(high.x, high.y, high.z));
}

/// Throws Error (ExitCode::input) when the point lies too far away for T.
template <typename T>
typename Flat<T>::Packed3 pack_position(const ViewFrame& view, const glm::dvec3& scene_point);

template <typename T>
typename Flat<T>::Sphere flatten_sphere(const ViewFrame& view, const Scene::Sphere& sphere);

template <typename T>
typename Flat<T>::Cone flatten_cone(const ViewFrame& view, const Scene::Cone& cone);

/// Where the point lies if it is on the shape or within ulps u of it: RT_ON as far as double can
/// tell, RT_OUTSIDE, RT_INSIDE; else 0.
template <typename T>
int side_of_sphere(const ViewFrame& view, const Scene::Sphere& sphere, const glm::dvec3& point,
                   double ulps);
template <typename T>
int side_of_cone(const ViewFrame& view, const Scene::Cone& cone, const glm::dvec3& point,
                 double ulps);

/// A flat triangle.
template <typename T>
typename Flat<T>::Triangle flatten_triangle(const ViewFrame& view,
                                            const TriangleList::Corners& corners, int material);

template <typename T>
typename Flat<T>::VertexNormals flatten_normals(const TriangleList::Corners& normals);

inline bool is_black(const glm::dvec3& color) { return color == glm::dvec3(0); }

template <typename T>
typename Flat<T>::Material flatten_material(const Scene::Material& material);

/// What the materials used by some primitive do with light.
struct MaterialUse {
    bool reflects_lights = false;  ///< one is diffuse or specular
    bool mirrors = false, transmits = false;
    bool splits = false;  ///< one both mirrors and transmits
};

MaterialUse material_use(const Scene& scene);

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Sphere& sphere);

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Cone& cone);

/// For the vertices as rounded.
template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Packed3& a, const typename Flat<T>::Packed3& b,
                 const typename Flat<T>::Packed3& c);

}  // namespace rt
