// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_cache.h"

#include "host/opencl/open_devices.h"

namespace rt {

RenderCache::RenderCache() : devices(std::make_shared<OpenDevices>()) {}

}  // namespace rt
