// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crew_members.h"

#include "host/opencl/cl_renderer.h"
#include "host/opencl/cl_tiles.h"
#include "host/picture/tile_check.h"

namespace rt {

namespace {

ClOptions cl_options(const RenderSettings& settings, bool refines, bool is_alone) {
    ClOptions options;
    options.kernels = settings.kernels;
    options.math = settings.math;
    options.will_refine = refines;
    options.shares_film = !is_alone;
    return options;
}

}  // namespace

ThreadsOptions threads_options(const RenderSettings& settings, int threads) {
    return {threads > 0 ? threads : settings.threads, settings.schedule, settings.kernels};
}

template <typename T>
CrewMember<T> threads_member(const SharedScene<T>& scene, const ThreadsOptions& options) {
    const auto make = [scene, options] { return make_threads_renderer<T>(*scene, options); };
    const auto renderer = make();
    return {"threads",
            renderer->tile_size(static_cast<int>(scene->params.width)),
            renderer->most_tile_pixels(),
            make,
            {}};
}

template <typename T>
CrewMember<T> device_member(const SharedScene<T>& scene, const RenderSettings& settings,
                            const ClDevice& device, bool refines, bool is_alone,
                            const std::shared_ptr<OpenDevices>& open,
                            const std::function<void()>& loaded) {
    ClOptions options = cl_options(settings, refines, is_alone);
    options.open_devices = open.get();
    const ClTiles tiles =
        cl_tiles<T>(scene->params, device, options, static_cast<int>(scene->params.width));
    CrewMember<T> member{device.name, tiles.best, tiles.most_pixels, {}, {}};
    member.make = [scene, device, options, open, loaded] {
        auto renderer = make_cl_renderer<T>(*scene, device, options);
        if (loaded) loaded();
        return renderer;
    };
    if (settings.self_test && settings.math == Math::strict) {
        const std::string isa = settings.kernels.isa;
        member.test = [scene, name = device.name, isa, refines](Renderer<T>& renderer) {
            self_test(renderer, name, *scene, isa, refines);
        };
    }
    return member;
}

template <typename T>
CrewMember<T> unlisted_member(const SharedScene<T>& scene, const ThreadsOptions& stand_in,
                              const DeviceChoice& choice) {
    CrewMember<T> member = threads_member<T>(scene, stand_in);
    member.name = choice.device.name;
    member.failure = choice.failure;
    return member;
}

template CrewMember<float> unlisted_member(const SharedScene<float>&, const ThreadsOptions&,
                                           const DeviceChoice&);
template CrewMember<double> unlisted_member(const SharedScene<double>&, const ThreadsOptions&,
                                            const DeviceChoice&);
template CrewMember<float> threads_member(const SharedScene<float>&, const ThreadsOptions&);
template CrewMember<double> threads_member(const SharedScene<double>&, const ThreadsOptions&);
template CrewMember<float> device_member(const SharedScene<float>&, const RenderSettings&,
                                         const ClDevice&, bool, bool,
                                         const std::shared_ptr<OpenDevices>&,
                                         const std::function<void()>&);
template CrewMember<double> device_member(const SharedScene<double>&, const RenderSettings&,
                                          const ClDevice&, bool, bool,
                                          const std::shared_ptr<OpenDevices>&,
                                          const std::function<void()>&);

}  // namespace rt
