// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "host/console.h"
#include "host/error.h"
#include "host/report/cost_text.h"
#include "host/report/result_file.h"
#include "host/report/run_json.h"
#include "host/report/statistics.h"
#include "host/report/stats_json.h"
#include "host/report/stress_json.h"
#include "host/report/stress_text.h"
#include "host/stop_signal.h"
#include "host/stress/naive_tracer.h"
#include "host/verbs/default_scene.h"
#include "host/verbs/measure.h"
#include "host/verbs/picture_job.h"
#include "host/verbs/stress_run.h"
#include "host/verbs/technique_cost.h"
#include "host/verbs/timing_loop.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

constexpr int cost_repeats = 7;

/// The paper's scene on threads in float, robust and naive interleaved, medians after a warm-up.
StressCost measure_cost() {
    Scene scene = load_default_scene();
    set_image_size(scene, 300, 300);
    RenderOptions options = timed_options();
    options.device = "threads";
    std::vector<double> robust, naive;
    for (int i = 0; i <= cost_repeats; ++i) {
        const double first = render_picture(scene, options).stats.phases.renderer.trace;
        const double second = naive_picture<float>(scene, NaiveStart::along_normal).seconds;
        if (i == 0) continue;
        robust.push_back(first);
        naive.push_back(second);
    }
    return StressCost{default_scene_path, median(robust), median(naive)};
}

std::vector<StressFamily> families_for(const StressOptions& options) {
    return chosen_families(all_stress_families(), options.cases, options.except, options.quick);
}

void make_folder(const std::string& folder) {
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) {
        throw Error(ExitCode::output,
                    fmt::format("{}: cannot make the folder: {}", folder, error.message()));
    }
}

}  // namespace

StressResult measure_stress(const StressOptions& options) {
    StressResult result = run_stress_cases(families_for(options), options);
    if (options.naive && !result.interrupted) result.cost = measure_cost();
    return result;
}

namespace {

int run_cost(const StressOptions& options) {
    check_result_path(options.json, json_start("mirrorball-stress"));
    const StressResult result = measure_technique_costs(options);
    if (options.json != "-") print_result(cost_text(result.costs));
    write_result(options.json, options.json.empty() ? "" : json_text(stress_json(result)));
    return result.interrupted ? 128 + stop_flag() : static_cast<int>(ExitCode::done);
}

}  // namespace

int run_stress(const StressOptions& options) {
    const std::vector<StressFamily> families = families_for(options);
    if (options.list) {
        print_result(stress_list(families));
        return 0;
    }
    if (options.cost) return run_cost(options);
    check_result_path(options.json, json_start("mirrorball-stress"));
    make_folder(options.output);
    const StressResult result = measure_stress(options);
    if (options.json != "-") print_result(stress_text(result, options.verbose));
    write_result(options.json, options.json.empty() ? "" : json_text(stress_json(result)));
    if (result.interrupted) return 128 + stop_flag();
    return static_cast<int>(result.passed() ? ExitCode::done : ExitCode::different);
}

}  // namespace rt
