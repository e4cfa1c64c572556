// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_cache.h"

#include "host/base/hash.h"
#include "host/opencl/cl_options.h"

namespace rt {

RenderCache::RenderCache() : devices(make_open_devices()) {}

std::uint64_t RenderCache::flat_key(const Scene& scene, std::uint64_t hash) {
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

}  // namespace rt
