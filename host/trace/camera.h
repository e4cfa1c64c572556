// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "host/trace/math.h"
#include "host/trace/sampling.h"
#include "host/trace/scene_view.h"

// Twin of kernels/camera.cl: eye rays.
namespace rt::trace {

/// The ray through sample k of pixel (x, y), x to the right and y up.
template <typename T>
Ray<T> camera_ray(const typename Flat<T>::Frame& frame, typename Flat<T>::Index x,
                  typename Flat<T>::Index y, typename Flat<T>::Index k) {
    const Position<T> offset = sample_position<T>(frame, x, y, k);
    const T sx = T(2) * (T(x) + offset.x) - T(frame.width);
    const T sy = T(2) * (T(y) + offset.y) - T(frame.height);
    const Vec3<T> direction = load3(frame.direction);
    const Vec3<T> dx = load3(frame.direction_dx);
    const Vec3<T> dy = load3(frame.direction_dy);
    const Vec3<T> across = add_scaled(direction, sx, dx);
    const Vec3<T> through = add_scaled(across, sy, dy);
    Vec3<T> low = add_scaled(load3(frame.direction_low), sx, load3(frame.direction_dx_low));
    low = add_scaled(low, sy, load3(frame.direction_dy_low));
    low = low + lost3(direction, sx, dx, across) + lost3(across, sy, dy, through);
    Ray<T> ray;
    const T inverse = T(1) / length3(through);
    ray.dir = inverse * through;
    ray.dir_low = add_scaled(add_scaled(-ray.dir, inverse, through), inverse, low);
    ray.origin = add_scaled(sx * load3(frame.origin_dx), sy, load3(frame.origin_dy));
    ray.t_max = std::numeric_limits<T>::infinity();
    ray.from = frame.eye_on_surface != 0 ? Flat<T>::eye : Flat<T>::none;
    return ray;
}

}  // namespace rt::trace
