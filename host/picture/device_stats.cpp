// SPDX-License-Identifier: Apache-2.0
#include "host/picture/device_stats.h"

#include "host/opencl/cl_tiles.h"
#include "host/picture/crew_members.h"

namespace rt {

template <typename T>
DeviceStats threads_stats(const FlatScene<T>& scene, const AaMode& aa,
                          const ThreadsOptions& options) {
    const NativeKernels<T>& kernels = native_kernels_for(scene, options);
    DeviceStats stats;
    stats.lanes = kernels.lanes;
    stats.isa = kernels.isa;
    stats.kernels = kernels.features;
    stats.name = "threads";
    stats.threads = thread_count(options, aa.samples());
    stats.schedule = to_string(options.schedule);
    return stats;
}

template <typename T>
DeviceStats stats_of(const std::vector<DeviceChoice>& devices, const FlatScene<T>& scene,
                     const AaMode& aa, const RenderSettings& settings) {
    DeviceStats stats;
    stats.name = joined_names(devices);
    if (devices.size() > 1) return stats;
    if (devices.front().use_threads) {
        return threads_stats(scene, aa, threads_options(settings, devices.front().threads));
    }
    const ClDevice& device = devices.front().device;
    stats.platform = device.platform;
    stats.driver = device.driver;
    stats.launch = launches_samples(settings.kernels.launch, device) ? "sample" : "pixel";
    stats.lanes = packet_lanes<T>(settings.kernels.lanes, device);
    stats.kernels = either_of(scene.features, settings.kernels.features);
    return stats;
}

std::string joined_names(const std::vector<DeviceChoice>& devices) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        names +=
            (names.empty() ? "" : " + ") + (choice.use_threads ? "threads" : choice.device.name);
    }
    return names;
}

std::string inexact_names(const std::vector<DeviceChoice>& devices) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        const bool is_exact =
            choice.use_threads || choice.device.rounds_correctly || !choice.failure.empty();
        if (!is_exact) names += choice.device.name + "\n";
    }
    return names;
}

void say_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                          const RenderEvents& events) {
    const auto say = [&](const std::string& line) {
        if (events.message) events.message(line);
    };
    if (choice.use_threads) {
        if (settings.kernels.launch != Launch::automatic) {
            say("--launch has no effect on threads");
        }
        if (settings.math == Math::fast) say("--math fast has no effect on threads");
        return;
    }
    if (settings.schedule != Schedule::tiles) {
        say("--schedule has no effect on OpenCL devices");
    }
    if (!choice.failure.empty()) return;
    if (settings.threads > 0 && choice.device.platform != pocl_platform) {
        say("--threads has no effect on " + choice.device.name);
    }
    if (settings.math == Math::strict && !choice.device.rounds_correctly && events.detail) {
        events.detail(choice.device.name +
                      " does not guarantee correctly rounded division and square roots, so its "
                      "pictures may differ in a few bits");
    }
}

template DeviceStats threads_stats(const FlatScene<float>&, const AaMode&, const ThreadsOptions&);
template DeviceStats threads_stats(const FlatScene<double>&, const AaMode&, const ThreadsOptions&);
template DeviceStats stats_of(const std::vector<DeviceChoice>&, const FlatScene<float>&,
                              const AaMode&, const RenderSettings&);
template DeviceStats stats_of(const std::vector<DeviceChoice>&, const FlatScene<double>&,
                              const AaMode&, const RenderSettings&);

}  // namespace rt
