// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "host/flatten/flat_types.h"
#include "host/flatten/triangle_list.h"
#include "host/flatten/view_frame.h"
#include "host/scene/scene.h"

// Primitives one by one, from the author's to the renderer's frame. All arithmetic is in double;
// rounding to T comes last.
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

}  // namespace rt
