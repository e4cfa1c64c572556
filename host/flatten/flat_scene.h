// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/flatten/features.h"
#include "host/flatten/flat_types.h"
#include "host/scene/scene.h"

namespace rt {

/// A scene as arrays of shared structs in the renderer's frame, in the precision of T (float or
/// double): everything a renderer reads, and all it reads.
template <typename T>
struct FlatScene {
    std::vector<typename Flat<T>::Sphere> spheres;
    std::vector<typename Flat<T>::Triangle> triangles;
    std::vector<typename Flat<T>::VertexNormals> vertex_normals;
    std::vector<typename Flat<T>::Material> materials;
    std::vector<typename Flat<T>::Light> lights;
    typename Flat<T>::Frame frame;
    Features features;

    std::size_t bytes() const;
};

/// Flattens a scene with its picture size, sampling and bounce limit. Lights that shine on nothing
/// are left out. Throws Error (ExitCode::input) when something lies too far away for T.
template <typename T>
FlatScene<T> flatten(const Scene& scene);

}  // namespace rt
