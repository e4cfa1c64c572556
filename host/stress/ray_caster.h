// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "host/flatten/flat_scene.h"
#include "host/render/ray_tracer.h"

namespace rt {

/// Makes tracers for the suite's ray trials: on threads, or on an OpenCL device.
struct RayCaster {
    std::function<RayTracer<float>(const FlatScene<float>&)> in_float;
    std::function<RayTracer<double>(const FlatScene<double>&)> in_double;

    template <typename T>
    RayTracer<T> tracer(const FlatScene<T>& scene) const {
        if constexpr (std::is_same_v<T, float>) {
            return in_float(scene);
        } else {
            return in_double(scene);
        }
    }
};

/// Native kernels on all cores, in packets of `lanes` rays (0: the vector width).
RayCaster threads_ray_caster(int lanes = 0);

}  // namespace rt
