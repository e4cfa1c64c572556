// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "host/flatten/flat_types.h"
#include "host/flatten/triangle_list.h"
#include "host/scene/scene.h"

namespace rt {

/// The frame the renderer works in, and the camera's axes in it. The eye becomes the origin and
/// lengths are scaled by a power of two that brings the median distance to a primitive near 1; both
/// are done in double before anything is rounded to float. A scene moved, or scaled by a power of
/// two, together with its camera then gives the same bits (docs/numerics.md).
struct ViewFrame {
    glm::dvec3 eye{0};           ///< in scene units; an orthographic window's center
    double scale = 1;            ///< a power of two
    bool is_perspective = true;  ///< all eye rays start at the eye
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal

    glm::dvec3 to_view(const glm::dvec3& scene_point) const { return (scene_point - eye) * scale; }
};

/// `triangles` are the scene's.
ViewFrame make_view_frame(const Scene& scene, const TriangleList& triangles, int threads);

/// Points, in scene units, whose convex hull contains the origins of all eye rays.
std::vector<glm::dvec3> eye_ray_origins(const ViewFrame& view, const Scene& scene);

/// Camera, sampling, bounces, background and ambient light; the counts of primitives and the roots
/// of hierarchies are left 0.
template <typename T>
typename Flat<T>::LaunchParams flatten_params(const ViewFrame& view, const Scene& scene);

}  // namespace rt
