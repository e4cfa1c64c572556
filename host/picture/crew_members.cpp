// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/opencl/cl_renderer.h"
#include "host/picture/crew.h"

namespace rt {

std::string joined_names(const std::vector<DeviceChoice>& devices) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        names +=
            (names.empty() ? "" : " + ") + (choice.use_threads ? "threads" : choice.device.name);
    }
    return names;
}

std::string inexact_names(const std::vector<DeviceChoice>& devices, Precision precision) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        if (!choice.is_exact(precision)) names += choice.device.name + "\n";
    }
    return names;
}

void warn_of_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                              const AaMode& aa, const RenderEvents& events) {
    const auto warn = [&](bool is_given, const std::string& option, const std::string& device) {
        if (is_given && events.message) events.message(option + " has no effect on " + device);
    };
    if (choice.use_threads) {
        warn(settings.schedule != Schedule::tiles && !aa.fixed_samples(), "--schedule",
             to_string(aa));
        warn(settings.kernels.launch != Launch::automatic, "--launch", "threads");
        warn(settings.math == Math::fast, "--math fast", "threads");
        warn(!build_extras().options.empty(), "--cl-options", "threads");
        warn(!build_extras().folder.empty(), "--save-kernels", "threads");
        if (std::max(choice.threads, settings.threads) > available_cores() && events.message) {
            events.message("more threads than the " + counted(available_cores(), "core") +
                           " available here; they take turns");
        }
        return;
    }
    warn(settings.schedule != Schedule::tiles, "--schedule", "OpenCL devices");
    warn(!settings.kernels.isa.empty(), "--isa", "OpenCL devices");
    if (!choice.failure.empty()) return;
    const bool is_pocl = choice.device.platform == pocl_platform;
    warn(settings.threads > 0 && !is_pocl, "--threads", choice.device.name);
    if (settings.math == Math::strict && !choice.is_exact(settings.precision) && events.detail) {
        events.detail(choice.device.name +
                      " does not guarantee correctly rounded division and square roots, and "
                      "subnormal numbers, so its pictures may differ in a few bits");
    }
}

template <typename T>
std::vector<CrewMember<T>> CrewMaker<T>::members(const std::vector<DeviceChoice>& devices) const {
    const bool is_alone = devices.size() == 1;
    const bool is_whole = is_alone && aa.fixed_samples();
    std::vector<CrewMember<T>> members;
    for (const DeviceChoice& choice : devices) {
        if (choice.use_threads) {
            members.push_back(
                threads_member({choice.threads > 0 ? choice.threads : settings.threads,
                                is_whole ? settings.schedule : Schedule::tiles, settings.kernels}));
        } else {
            members.push_back(device_member(choice.device, is_alone));
            members.back().failure = choice.failure;
        }
    }
    return members;
}

template <typename T>
CrewMember<T> CrewMaker<T>::threads_member(const ThreadsOptions& options) const {
    const auto make = [scene = scene, options] {
        return make_threads_renderer<T>(*scene, options);
    };
    const TileSizes tiles = make()->tile_sizes(static_cast<int>(scene->params.width));
    CrewMember<T> member{"threads", tiles, make, {}};
    const NativeKernels<T>& kernels = native_kernels_for(*scene, options);
    member.stats.name = member.name;
    member.stats.lanes = kernels.lanes;
    member.stats.isa = kernels.isa;
    member.stats.kernels = kernels.features;
    member.stats.threads = thread_count(options, aa.samples());
    member.stats.schedule = to_string(options.schedule);
    return member;
}

template <typename T>
CrewMember<T> CrewMaker<T>::device_member(const ClDevice& device, bool is_alone) const {
    ClOptions options;
    options.kernels = settings.kernels;
    options.math = settings.math;
    options.shares_film = !is_alone;
    options.open_devices = open;
    const TileSizes tiles =
        cl_tile_sizes<T>(scene->params, device, options, static_cast<int>(scene->params.width));
    CrewMember<T> member{device.name, tiles, {}, {}};
    member.make = [scene = scene, device, options, loaded = loaded] {
        auto renderer = make_cl_renderer<T>(*scene, device, options);
        if (loaded) loaded();
        return renderer;
    };
    if (settings.self_test && settings.math == Math::strict) {
        member.test = [scene = scene, device, isa = settings.kernels.isa](Renderer<T>& renderer) {
            self_test(renderer, device, *scene, isa);
        };
    }
    const bool by_samples = launches_samples(settings.kernels.launch, device, !aa.fixed_samples());
    member.stats.name = member.name;
    member.stats.platform = device.platform;
    member.stats.driver = device.driver;
    member.stats.launch = by_samples ? "sample" : "pixel";
    member.stats.lanes = packet_lanes<T>(settings.kernels.lanes, device);
    member.stats.kernels = scene->features | settings.kernels.features;
    return member;
}

template struct CrewMaker<float>;
template struct CrewMaker<double>;

}  // namespace rt
