// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_options.h"
#include "host/opencl/device_spec.h"
#include "host/picture/crew.h"
#include "host/picture/render_picture.h"
#include "host/picture/render_settings.h"
#include "host/render/threads_renderer.h"

// The devices that render a picture: who they are, their renderers, and what is kept for the next.
namespace rt {

/// A scene ready to render, shared by all its renderers.
template <typename T>
using SharedScene = std::shared_ptr<const FlatScene<T>>;

/// What is kept between pictures with the same settings: open devices, their programs, and the last
/// flattened scene.
struct RenderCache {
    template <typename T>
    struct Flattened {
        std::uint64_t hash = 0;    ///< scene_hash of its scene, and
        PictureSpec picture;       ///< the settings that flattening reads
        std::uint64_t shapes = 0;  ///< shapes_hash of its scene
        SharedScene<T> scene;      ///< null: none yet
    };

    std::shared_ptr<OpenDevices> devices = make_open_devices();
    std::tuple<Flattened<float>, Flattened<double>> scenes;
    bool has_warned = false;  ///< of what users should know of devices and settings
};

/// "threads + NVIDIA H100".
std::string joined_names(const std::vector<DeviceChoice>& devices);

/// The names of devices whose bits may differ from the others'; "" if there are none.
std::string inexact_names(const std::vector<DeviceChoice>& devices);

/// Warns of settings that do not apply to the device and would be dropped silently.
void warn_of_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                              const RenderEvents& events);

/// Makes the renderers of a scene, and describes them for figures.
template <typename T>
struct CrewMaker {
    /// A member for each device. An OpenCL device is opened (or reused), compiled and uploaded to,
    /// and tested by self_test; one that its driver could not list fails.
    std::vector<CrewMember<T>> members(const std::vector<DeviceChoice>& devices) const;

    /// Threads that stand in for devices, some tiles of which may be finished: they cannot render
    /// whole sample buffers, and the settings of packets are the devices'.
    CrewMember<T> spare() const;

    SharedScene<T> scene;
    const RenderSettings& settings;
    AaMode aa;
    std::shared_ptr<OpenDevices> open;  ///< devices to reuse
    std::function<void()> loaded;  ///< called when a driver was loaded, which may have replaced
                                   ///< signal handlers

    CrewMember<T> threads_member(const ThreadsOptions& options) const;
    CrewMember<T> device_member(const ClDevice& device, bool is_alone) const;
};

}  // namespace rt
