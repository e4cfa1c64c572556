// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/opencl/device_spec.h"
#include "host/picture/render_picture.h"
#include "host/picture/render_settings.h"
#include "host/picture/render_stats.h"
#include "host/render/threads_renderer.h"

// Who renders, for figures and messages.
namespace rt {

template <typename T>
DeviceStats threads_stats(const FlatScene<T>& scene, const AaMode& aa,
                          const ThreadsOptions& options);

template <typename T>
DeviceStats device_stats(const ClDevice& device, const RenderSettings& settings);

/// "threads + NVIDIA H100".
std::string joined_names(const std::vector<DeviceChoice>& devices);

/// Of those whose bits may be their own; "" where there are none.
std::string inexact_names(const std::vector<DeviceChoice>& devices);

/// Names the settings that mean nothing on the device, which would be dropped in silence.
void say_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                          const RenderEvents& events);

}  // namespace rt
