// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/technique_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "host/console.h"
#include "host/error.h"
#include "host/flatten/flat_scene.h"
#include "host/processor_time.h"
#include "host/render/device_spec.h"
#include "host/render/picture_loop.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/stop_signal.h"
#include "host/stress/naive_tracer.h"
#include "host/verbs/default_scene.h"
#include "host/verbs/device_list.h"
#include "host/verbs/timing_loop.h"

namespace rt {

namespace {

/// One way to render the picture; returns the seconds of tracing it.
struct Contender {
    TechniqueCost cost;
    std::function<double()> trace;
};

/// The first contender is the robust one.
using Contenders = std::vector<Contender>;

std::function<double()> tracing(std::shared_ptr<Renderer<float>> renderer, const Scene& scene,
                                bool of_processor) {
    return [renderer = std::move(renderer), &scene, of_processor] {
        const Rect region{0, 0, scene.width, scene.height};
        const Rect tile = renderer->tile_size(scene.width);
        TileQueue queue(make_tiles(region, tile.width, tile.height), stop_flag());
        Film<float> film(scene.width, scene.height);
        const Stopwatch watch;
        const double start = processor_seconds();
        render_all(*renderer, scene.aa, queue, region, film);
        return of_processor ? processor_seconds() - start : watch.seconds();
    };
}

Contender without(const Techniques& naive, const char* name, const char* how, const Scene& scene,
                  const FlatScene<float>& flat, const ClDevice& device) {
    ClOptions options;
    options.naive = naive;
    options.will_refine = scene.aa.refines();
    return {{name, how, 0}, tracing(make_cl_renderer(flat, device, options), scene, device.is_cpu)};
}

/// Built-in powers can cost more than all techniques together, so all are made naive with and
/// without the lobe.
Contenders on_device(const Scene& scene, const FlatScene<float>& flat, const ClDevice& device) {
    Contenders contenders;
    contenders.push_back(without({}, "", "", scene, flat, device));
    contenders.push_back(without({}, "nothing", "run-to-run noise", scene, flat, device));
    for (const Technique& technique : techniques) {
        Techniques naive;
        naive.*technique.flag = true;
        contenders.push_back(without(naive, technique.name, technique.naive, scene, flat, device));
    }
    Techniques all = all_techniques();
    contenders.push_back(without(all, "all", "a textbook's", scene, flat, device));
    all.lobe = false;
    contenders.push_back(without(all, "all but lobe", "", scene, flat, device));
    return contenders;
}

Contenders on_threads(const Scene& scene, const FlatScene<float>& flat, int threads) {
    ThreadsOptions options;
    options.threads = threads;
    Contenders contenders;
    contenders.push_back({{"", "", 0}, tracing(make_threads_renderer(flat, options), scene, true)});
    contenders.push_back({{"all", "a textbook's", 0}, [&scene, threads] {
                              return naive_picture<float>(scene, NaiveStart::along_normal, threads)
                                  .processor_seconds;
                          }});
    return contenders;
}

/// Renders each once to warm up, then interleaved; keeps the fastest. False at a stop signal.
bool run_contenders(Contenders& contenders, int repeats) {
    for (int round = 0; round <= repeats; ++round) {
        for (Contender& contender : contenders) {
            const double seconds = contender.trace();
            if (stop_flag() != 0) return false;
            double& fastest = contender.cost.seconds;
            fastest = round <= 1 ? seconds : std::min(fastest, seconds);
        }
    }
    return true;
}

CostTable empty_table(const std::string& path, const Scene& scene, const ListedDevice& device,
                      int repeats) {
    CostTable table;
    table.scene = path;
    table.renderer = device.name;
    table.device = device.spec;
    table.width = scene.width;
    table.height = scene.height;
    table.aa = to_string(scene.aa);
    table.repeats = repeats;
    return table;
}

ClDevice opened(const ListedDevice& listed) {
    std::vector<std::string> problems;
    const std::vector<ClDevice> devices = list_cl_devices(problems);
    return choose_device(listed.spec, devices, problems).device;
}

}  // namespace

StressResult measure_technique_costs(const StressOptions& options) {
    StressResult result;
    result.load_before = load_average();
    const Stopwatch watch;
    const std::vector<ListedDevice> devices = listed_devices(options.devices);
    std::vector<std::string> paths{default_scene_path};
    if (!options.cost_scene.empty()) paths.push_back(options.cost_scene);
    install_stop_signals();
    for (const std::string& path : paths) {
        const Scene scene = path == default_scene_path ? load_default_scene() : load_scene(path);
        const FlatScene<float> flat = flatten<float>(scene);
        for (const ListedDevice& device : devices) {
            if (!options.quiet) {
                print_message(fmt::format("mirrorball: {} on {}\n", path, device.name));
            }
            const bool is_processor = device.is_threads || opened(device).is_cpu;
            Contenders contenders = device.is_threads ? on_threads(scene, flat, device.threads)
                                                      : on_device(scene, flat, opened(device));
            if (!run_contenders(contenders, options.repeats)) break;
            CostTable table = empty_table(path, scene, device, options.repeats);
            table.of_processor = is_processor;
            table.robust_seconds = contenders.front().cost.seconds;
            for (std::size_t i = 1; i < contenders.size(); ++i) {
                table.rows.push_back(contenders[i].cost);
            }
            result.costs.push_back(std::move(table));
        }
        if (stop_flag() != 0) break;
    }
    result.interrupted = stop_flag() != 0;
    result.seconds = watch.seconds();
    return result;
}

}  // namespace rt
