// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "host/trace/math.h"
#include "host/trace/scene_view.h"

// Twin of kernels/camera.cl: eye rays.
namespace rt::trace {

/// The ray through sample k of pixel (x, y), x to the right and y up; sample k lies at column
/// k % grid and row k / grid of the pixel's grid, at (i + 0.5) / grid.
template <typename T>
Ray<T> camera_ray(const typename Flat<T>::Frame& frame, typename Flat<T>::Index x,
                  typename Flat<T>::Index y, typename Flat<T>::Index k) {
    const T grid = T(frame.grid);
    const T offset_x = (T(k % frame.grid) + T(0.5)) / grid;
    const T offset_y = (T(k / frame.grid) + T(0.5)) / grid;
    const T sx = T(2) * (T(x) + offset_x) - T(frame.width);
    const T sy = T(2) * (T(y) + offset_y) - T(frame.height);
    const Vec3<T> across = add_scaled(load3(frame.direction), sx, load3(frame.direction_dx));
    Ray<T> ray;
    ray.dir = normalize3(add_scaled(across, sy, load3(frame.direction_dy)));
    ray.origin = add_scaled(sx * load3(frame.origin_dx), sy, load3(frame.origin_dy));
    ray.t_max = std::numeric_limits<T>::infinity();
    ray.from = Flat<T>::none;
    return ray;
}

}  // namespace rt::trace
