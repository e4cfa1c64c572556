// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "host/flatten/flat_scene.h"
#include "host/opencl/device_spec.h"
#include "host/picture/crew.h"
#include "host/picture/render_settings.h"
#include "host/render/threads_renderer.h"

namespace rt {

class OpenDevices;

/// A scene ready to render, shared by all its renderers.
template <typename T>
using SharedScene = std::shared_ptr<const FlatScene<T>>;

/// The settings for the pthreads renderer. `threads`: 0 means the settings'.
ThreadsOptions threads_options(const RenderSettings& settings, int threads);

/// Threads, ready at once.
template <typename T>
CrewMember<T> threads_member(const SharedScene<T>& scene, const ThreadsOptions& options);

/// An OpenCL device, created by opening it (or reusing it from `open`), compiling and uploading,
/// and tested by self_test. `loaded` is called after creation: drivers replace signal handlers.
template <typename T>
CrewMember<T> device_member(const SharedScene<T>& scene, const RenderSettings& settings,
                            const ClDevice& device, bool refines, bool is_alone,
                            const std::shared_ptr<OpenDevices>& open,
                            const std::function<void()>& loaded);

/// A device whose driver could not list it: creating its renderer throws Error
/// (ExitCode::device).
template <typename T>
CrewMember<T> unlisted_member(const SharedScene<T>& scene, const ThreadsOptions& stand_in,
                              const DeviceChoice& choice);

}  // namespace rt
