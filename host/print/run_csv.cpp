// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <vector>

#include "host/base/text.h"
#include "host/base/version.h"
#include "host/print/environment_json.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

/// What a line holds besides the run itself.
struct RunPlace {
    std::string device, verdict;
    int round = 0;  ///< 0: warm-up; repeats from 1
};

std::vector<std::string> what_cells(const RenderStats& run, const RunPlace& place) {
    return {quoted(printable(run.scene.path)),
            hash_text(run.scene.hash),
            std::to_string(run.width),
            std::to_string(run.height),
            to_string(run.aa),
            std::to_string(run.max_bounces),
            precision_name(run.double_precision),
            math_name(run.fast_math),
            quoted(place.device),
            quoted(run.device.name),
            std::to_string(run.device.threads),
            run.device.schedule,
            run.device.launch,
            place.verdict,
            std::to_string(place.round)};
}

std::vector<std::string> figure_cells(const RenderStats& run) {
    const RendererTimes& times = run.phases.renderer;
    std::vector<std::string> cells;
    for (const double seconds :
         {run.phases.load, run.phases.flatten, times.open, times.build, times.upload, times.trace,
          times.kernel, times.resolve, times.read_back, run.phases.total}) {
        cells.push_back(fmt::format("{}", seconds));
    }
    for (const auto rays :
         {run.rays.primary, run.rays.shadow, run.rays.mirror, run.rays.transmitted}) {
        cells.push_back(fmt::format("{}", rays));
    }
    cells.push_back(fmt::format("{}", run.rays_per_second()));
    cells.push_back(hash_text(run.image_hash));
    cells.push_back(run.error ? fmt::format("{}", run.error->rmse) : "");
    cells.push_back(run.error ? fmt::format("{}", run.error->max) : "");
    cells.push_back(std::to_string(run.non_finite));
    return cells;
}

/// What produced the numbers: processor, driver, program.
std::vector<std::string> maker_cells(const RenderStats& run) {
    static const std::string machine = cpu_name();
    return {quoted(machine), quoted(run.device.driver),
            fmt::format("{} ({})", version, git_revision)};
}

std::string line_of(const RenderStats& run, const RunPlace& place) {
    std::string line;
    for (const auto& cells : {what_cells(run, place), figure_cells(run), maker_cells(run)}) {
        for (const std::string& cell : cells) line += cell + ",";
    }
    line.back() = '\n';
    return line;
}

}  // namespace

std::string run_csv_header() {
    return "scene,scene_hash,width,height,aa,max_bounces,precision,math,device,device_name,threads,"
           "schedule,launch,verdict,round,load,flatten,open,build,upload,trace,kernel,"
           "resolve,read_back,total,primary_rays,shadow_rays,mirror_rays,transmitted_rays,rays_per_"
           "second,"
           "image_hash,rmse,max_error,non_finite,machine,driver,version";
}

std::string runs_csv(const TimedRuns& runs, const std::string& device) {
    RunPlace place{device, to_string(runs.verdict)};
    std::string text;
    for (const RenderStats& run : runs.warm_up) text += line_of(run, place);
    for (const RenderStats& run : runs.repeats) {
        ++place.round;
        text += line_of(run, place);
    }
    return text;
}

}  // namespace rt
