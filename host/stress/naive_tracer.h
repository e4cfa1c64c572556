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
    /// For tracing, without scene preparation: wall-clock time, and CPU time over all cores.
    double seconds = 0, processor_seconds = 0;
};

/// Renders the scene as a textbook would, in the arithmetic of T, on so many threads (0: all
/// cores): original coordinates, quadratic formula, Moller-Trumbore with |det| < 1e-8, pow(n.h, e),
/// a BVH with tight boxes over many triangles. For comparison only. Supports sample grids, spheres,
/// cones and triangles.
template <typename T>
NaivePicture naive_picture(const Scene& scene, NaiveStart start, int threads = 0);

}  // namespace rt
