// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture.h"
#include "host/scene/scene.h"

namespace rt {

/// How a textbook keeps a secondary ray off the surface it leaves.
enum class NaiveStart {
    least_distance,  ///< hits count from t > 1e-3
    along_normal,    ///< the ray starts 1e-4 n off the surface
};

struct NaivePicture {
    Picture picture;
    /// Of tracing, without making the scene ready: by the clock, and of all cores together.
    double seconds = 0, processor_seconds = 0;
};

/// The scene as a textbook renders it in the arithmetic of T, on all cores (0) or so many threads:
/// coordinates as they are, the quadratic formula, Moller and Trumbore with |det| < 1e-8,
/// pow(n.h, e), tight boxes about many triangles. For comparison only. Grids of samples; spheres,
/// cones and triangles.
template <typename T>
NaivePicture naive_picture(const Scene& scene, NaiveStart start, int threads = 0);

}  // namespace rt
