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

// Describes the devices that render, for figures and messages.
namespace rt {

template <typename T>
DeviceStats threads_stats(const FlatScene<T>& scene, const AaMode& aa,
                          const ThreadsOptions& options);

/// Of several devices, only their names.
template <typename T>
DeviceStats stats_of(const std::vector<DeviceChoice>& devices, const FlatScene<T>& scene,
                     const AaMode& aa, const RenderSettings& settings);

/// "threads + NVIDIA H100".
std::string joined_names(const std::vector<DeviceChoice>& devices);

/// The names of devices whose bits may differ from the others'; "" if there are none.
std::string inexact_names(const std::vector<DeviceChoice>& devices);

/// Reports settings that do not apply to the device and would be dropped silently.
void say_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                          const RenderEvents& events);

}  // namespace rt
