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
        std::uint64_t key = 0;     ///< flat_key of its scene
        std::uint64_t shapes = 0;  ///< shapes_hash of its scene
        SharedScene<T> scene;      ///< null: none yet
    };

    RenderCache();

    /// A hash of everything in a scene that flattening reads; `hash` is its scene_hash, which
    /// excludes the settings.
    static std::uint64_t flat_key(const Scene& scene, std::uint64_t hash);

    std::shared_ptr<OpenDevices> devices;
    std::tuple<Flattened<float>, Flattened<double>> scenes;
};

}  // namespace rt
