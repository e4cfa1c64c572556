// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_cache.h"

#include <utility>

#include "host/base/hash.h"
#include "host/opencl/cl_options.h"
#include "host/scene/scene_hash.h"

namespace rt {

namespace {

/// Of everything in a scene that flattening reads; `hash` is its scene_hash, which excludes the
/// settings.
std::uint64_t flat_key(const Scene& scene, std::uint64_t hash) {
    Hasher hasher;
    hasher.add(hash);
    hasher.add(scene.width);
    hasher.add(scene.height);
    hasher.add(static_cast<int>(scene.aa.pattern));
    hasher.add(scene.aa.count);
    hasher.add(static_cast<int>(scene.filter));
    hasher.add(scene.sampling_seed);
    hasher.add(scene.max_bounces);
    return hasher.value();
}

}  // namespace

RenderCache::RenderCache() : devices(make_open_devices()) {}

template <typename T>
SharedScene<T> flattened_scene(const Scene& scene, std::uint64_t hash,
                               const FlattenOptions& options, RenderCache& cache) {
    auto& kept = std::get<RenderCache::Flattened<T>>(cache.scenes);
    const std::uint64_t key = flat_key(scene, hash);
    if (kept.scene && kept.key == key) return kept.scene;
    const std::uint64_t shapes = shapes_hash(scene);
    const FlatScene<T>* same_shapes = kept.shapes == shapes ? kept.scene.get() : nullptr;
    auto scene_now = std::make_shared<const FlatScene<T>>(flatten<T>(scene, options, same_shapes));
    kept = {key, shapes, std::move(scene_now)};
    return kept.scene;
}

template SharedScene<float> flattened_scene(const Scene&, std::uint64_t, const FlattenOptions&,
                                            RenderCache&);
template SharedScene<double> flattened_scene(const Scene&, std::uint64_t, const FlattenOptions&,
                                             RenderCache&);

}  // namespace rt
