// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/picture/render_picture.h"

namespace rt {

/// Renders the scene with its own AA mode, which must not refine, and if the estimated RMSE is
/// above settings.target_rmse, once more with as many samples as that takes. They are found by
/// tracing the control pixels alone. If that is stopped, it returns the first picture.
RenderedPicture render_to_target(const Scene& scene, const RenderSettings& settings,
                                 const std::vector<DeviceChoice>& devices,
                                 const RenderEvents& events, const StopFlag& stop,
                                 RenderCache* cache = nullptr);

}  // namespace rt
