// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_run.h"

#include <fmt/ranges.h>

#include "host/base/version.h"
#include "host/measure/machine_load.h"
#include "host/print/print_stats.h"

namespace rt {

namespace {

/// A line of the CSV.
struct RunRow {
    const TimedRun& run;
    std::string device;  ///< as for --device
    Verdict verdict;     ///< of the row
    int round;           ///< 0: warm-up; repeats from 1
};

template <typename A, Of<RunRow> X>
void describe(A& a, X& x) {
    static const std::string machine = cpu_name();
    const TimedRun& run = x.run;
    const PictureSpec& picture = run.picture;
    const RendererTimes& times = run.phases.renderer;
    a("scene", printable(run.scene.path), "");
    a("scene_hash", hash_text(run.scene.hash), "");
    a("width", picture.width, "");
    a("height", picture.height, "");
    a("aa", picture.aa, "");
    a("filter", picture.filter, "");
    a("seed", picture.seed, "");
    a("max_bounces", picture.max_bounces, "");
    a("precision", picture.precision, "");
    a("math", picture.math, "");
    a("device", x.device, "");
    a("device_name", run.device.name, "");
    a("threads", run.device.threads, "");
    a("schedule", run.device.schedule, "");
    a("launch", run.device.launch, "");
    a("verdict", x.verdict, "");
    a("round", x.round, "");
    a("load", run.phases.load, "");
    a("flatten", run.phases.flatten, "");
    a("open", times.open, "");
    a("build", times.build, "");
    a("upload", times.upload, "");
    a("trace", times.trace, "");
    a("kernel", times.kernel, "");
    a("resolve", times.resolve, "");
    a("read_back", times.read_back, "");
    a("total", run.phases.total, "");
    a("primary_rays", run.rays.primary, "");
    a("shadow_rays", run.rays.shadow, "");
    a("mirror_rays", run.rays.mirror, "");
    a("transmitted_rays", run.rays.transmitted, "");
    a("rays_per_second", run.rays_per_second(), "");
    a("image_hash", hash_text(run.image_hash), "");
    a("rmse", run.error ? std::optional(run.error->rmse) : std::nullopt, "");
    a("max_error", run.error ? std::optional(run.error->max) : std::nullopt, "");
    a("non_finite", run.non_finite, "");
    a("machine", machine, "");
    a("driver", run.device.driver, "");
    a("version", fmt::format("{} ({})", version, git_revision), "");
}

std::string line_of(const RunRow& row) {
    return fmt::format("{}\n", fmt::join(csv_row(row).cells, ","));
}

std::string csv_header() {
    const TimedRun none;
    return fmt::format("{}\n", fmt::join(csv_row(RunRow{none, "", Verdict::right, 0}).names, ","));
}

/// `device`: as for --device.
void add_runs(const TimedRuns& runs, const std::string& device, std::string& text) {
    for (const TimedRun& run : runs.warm_up) text += line_of({run, device, runs.verdict, 0});
    int round = 0;
    for (const TimedRun& run : runs.repeats) {
        text += line_of({run, device, runs.verdict, ++round});
    }
}

}  // namespace

std::string json_start(const std::string& format) {
    return "{\n  \"format\": \"mirrorball-" + format + "\"";
}

Json bench_environment_json(double load_before) {
    Json json = environment_json();
    json.update(machine_load_json(load_before));
    return json;
}

std::string bench_csv(const BenchResult& result) {
    std::string text = csv_header();
    for (const BenchRow& row : result.rows) add_runs(row, row.asked.device, text);
    return text;
}

std::string converge_csv(const ConvergeResult& result) {
    std::string text = csv_header();
    for (const ConvergePoint& point : result.points) add_runs(point, point.asked.device, text);
    return text;
}

}  // namespace rt
