// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crew_members.h"

#include <algorithm>
#include <utility>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/cl_tiles.h"
#include "host/picture/tile_check.h"

namespace rt {

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
        if (!choice.is_exact()) names += choice.device.name + "\n";
    }
    return names;
}

void warn_of_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                              const RenderEvents& events) {
    const auto warn = [&](const std::string& line) {
        if (events.message) events.message(line);
    };
    if (choice.use_threads) {
        if (settings.kernels.launch != Launch::automatic) {
            warn("--launch has no effect on threads");
        }
        if (settings.math == Math::fast) warn("--math fast has no effect on threads");
        if (std::max(choice.threads, settings.threads) > available_cores()) {
            warn("more threads than the " + counted(available_cores(), "core") +
                 " available here; they take turns");
        }
        return;
    }
    if (settings.schedule != Schedule::tiles) {
        warn("--schedule has no effect on OpenCL devices");
    }
    if (!choice.failure.empty()) return;
    if (settings.threads > 0 && choice.device.platform != pocl_platform) {
        warn("--threads has no effect on " + choice.device.name);
    }
    if (settings.math == Math::strict && !choice.is_exact() && events.detail) {
        events.detail(choice.device.name +
                      " does not guarantee correctly rounded division and square roots, so its "
                      "pictures may differ in a few bits");
    }
}

template <typename T>
CrewMaker<T>::CrewMaker(SharedScene<T> scene, const RenderSettings& settings, const AaMode& aa,
                        std::shared_ptr<OpenDevices> open, std::function<void()> loaded)
    : scene_(std::move(scene)),
      settings_(settings),
      aa_(aa),
      open_(std::move(open)),
      loaded_(std::move(loaded)) {}

template <typename T>
std::vector<CrewMember<T>> CrewMaker<T>::members(const std::vector<DeviceChoice>& devices) const {
    const bool is_alone = devices.size() == 1;
    std::vector<CrewMember<T>> members;
    for (const DeviceChoice& choice : devices) {
        if (!choice.failure.empty()) {
            CrewMember<T>& unlisted = members.emplace_back(spare());
            unlisted.name = choice.device.name;
            unlisted.failure = choice.failure;
        } else if (choice.use_threads) {
            ThreadsOptions options = threads_options(choice.threads);
            if (!is_alone) options.schedule = Schedule::tiles;
            members.push_back(threads_member(options));
        } else {
            members.push_back(device_member(choice.device, is_alone));
        }
    }
    return members;
}

/// `threads`: 0 means the settings'.
template <typename T>
ThreadsOptions CrewMaker<T>::threads_options(int threads) const {
    return {threads > 0 ? threads : settings_.threads, settings_.schedule, settings_.kernels};
}

template <typename T>
ThreadsOptions CrewMaker<T>::spare_options() const {
    ThreadsOptions options = threads_options(0);
    options.schedule = Schedule::tiles;
    options.kernels.lanes = 0;
    return options;
}

template <typename T>
CrewMember<T> CrewMaker<T>::threads_member(const ThreadsOptions& options) const {
    const auto make = [scene = scene_, options] {
        return make_threads_renderer<T>(*scene, options);
    };
    const auto renderer = make();
    return {"threads",
            renderer->tile_size(static_cast<int>(scene_->params.width)),
            renderer->most_tile_pixels(),
            make,
            {}};
}

template <typename T>
CrewMember<T> CrewMaker<T>::device_member(const ClDevice& device, bool is_alone) const {
    ClOptions options;
    options.kernels = settings_.kernels;
    options.math = settings_.math;
    options.shares_film = !is_alone;
    options.open_devices = open_;
    const ClTiles tiles =
        cl_tiles<T>(scene_->params, device, options, static_cast<int>(scene_->params.width));
    CrewMember<T> member{device.name, tiles.best, tiles.most_pixels, {}, {}};
    member.make = [scene = scene_, device, options, loaded = loaded_] {
        auto renderer = make_cl_renderer<T>(*scene, device, options);
        if (loaded) loaded();
        return renderer;
    };
    if (settings_.self_test && settings_.math == Math::strict) {
        member.test = [scene = scene_, name = device.name, isa = settings_.kernels.isa](
                          Renderer<T>& renderer) { self_test(renderer, name, *scene, isa); };
    }
    return member;
}

template <typename T>
DeviceStats CrewMaker<T>::threads_stats(const ThreadsOptions& options) const {
    const NativeKernels<T>& kernels = native_kernels_for(*scene_, options);
    DeviceStats stats;
    stats.lanes = kernels.lanes;
    stats.isa = kernels.isa;
    stats.kernels = kernels.features;
    stats.name = "threads";
    stats.threads = thread_count(options, aa_.samples());
    stats.schedule = to_string(options.schedule);
    return stats;
}

template <typename T>
DeviceStats CrewMaker<T>::stats(const std::vector<DeviceChoice>& devices) const {
    DeviceStats stats;
    stats.name = joined_names(devices);
    if (devices.size() > 1) return stats;
    if (devices.front().use_threads) {
        return threads_stats(threads_options(devices.front().threads));
    }
    const ClDevice& device = devices.front().device;
    stats.platform = device.platform;
    stats.driver = device.driver;
    const bool in_rounds = !aa_.fixed_samples();
    stats.launch =
        launches_samples(settings_.kernels.launch, device, in_rounds) ? "sample" : "pixel";
    stats.lanes = packet_lanes<T>(settings_.kernels.lanes, device);
    stats.kernels = either_of(scene_->features, settings_.kernels.features);
    return stats;
}

template class CrewMaker<float>;
template class CrewMaker<double>;

}  // namespace rt
