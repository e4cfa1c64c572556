// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <tuple>

#include "host/picture/crew_members.h"

namespace rt {

/// What is kept between pictures with the same settings: open devices, their programs, and the last
/// flattened scene.
struct RenderCache {
    template <typename T>
    struct Flattened {
        std::uint64_t key = 0;     ///< of everything in its scene that flattening reads
        std::uint64_t shapes = 0;  ///< shapes_hash of its scene
        SharedScene<T> scene;      ///< null: none yet
    };

    RenderCache();

    std::shared_ptr<OpenDevices> devices;
    std::tuple<Flattened<float>, Flattened<double>> scenes;
};

/// Flattens a scene, whose scene_hash is `hash`. With a cache: the scene it keeps if that is the
/// same; otherwise the cache keeps this one, built with the hierarchies of the one before if only
/// the shapes are the same.
template <typename T>
SharedScene<T> flattened_scene(const Scene& scene, std::uint64_t hash,
                               const FlattenOptions& options, RenderCache& cache);

}  // namespace rt
