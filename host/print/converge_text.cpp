// SPDX-License-Identifier: Apache-2.0
#include "host/print/converge_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/measure/bench.h"
#include "host/measure/converge.h"
#include "host/measure/machine_load.h"

namespace rt {

namespace {

/// "0 pthread-AMD EPYC 7 float strict"
std::string who(const ConvergeCase& of) {
    std::string name = of.device;
    if (of.device_name.rfind("threads", 0) != 0) name += " " + of.device_name;
    return fmt::format("{:<20} {:<6} {:<6}", name.substr(0, 20),
                       of.double_precision ? "double" : "float", of.fast_math ? "fast" : "strict");
}

std::string point_text(const ConvergeResult& result, const ConvergePoint& point, bool on_front) {
    const std::string head = fmt::format("{} {:>7} {:<14}", who(point.asked),
                                         point.asked.max_bounces, to_string(point.asked.aa));
    const auto figures = figures_of(result, point);
    if (!figures) return fmt::format("{} {} {}\n", head, to_string(point.verdict), point.why);
    return fmt::format("{} {:>9.5f} {:>4.1f} {:>9.5f} {:>9.2e} {}{}\n", head,
                       figures->seconds.median, figures->seconds.noise_percent(),
                       figures->seconds.max, figures->rmse, on_front ? "*" : " ",
                       figures->below_floor ? "<" : "");
}

std::string points_text(const ConvergeResult& result) {
    std::string text =
        fmt::format("{:<20} {:<6} {:<6} {:>7} {:<14} {:>9} {:>4} {:>9} {:>9}\n", "device", "prec.",
                    "math", "bounces", "AA", "seconds", "+-%", "slowest", "RMSE");
    const auto front = front_of(result);
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        const bool on_front = std::find(front.begin(), front.end(), i) != front.end();
        text += point_text(result, result.points[i], on_front);
    }
    return text +
           "* on the Pareto front; < below the reference's own error: not to be told\n"
           "apart. seconds: medians without open and build; +-%: median absolute deviation.\n";
}

std::string curves_text(const ConvergeResult& result) {
    std::string text = "\nslope of log RMSE over log seconds\n";
    for (const Curve& curve : curves_of(result)) {
        if (!curve.slope) continue;
        text += fmt::format("{} {:>7} {:<14} {:>6.2f}\n", who(curve.of), curve.of.max_bounces,
                            curve.family, *curve.slope);
    }
    return text;
}

std::string builds_text(const ConvergeResult& result) {
    std::string text = fmt::format(
        "\non top of the first picture, seconds\n{:<34} {:>9} {:>11} {:<8} "
        "{:>11} {:>4}\n",
        "", "open", "first build", "cache", "later build", "+-%");
    for (const BuildOffset& offset : build_offsets(result)) {
        text += fmt::format("{} {:>9.5f} {:>11.5f} {:<8} {:>11.5f} {:>4.1f}\n", who(offset.of),
                            offset.open, offset.first_build, offset.first_cache,
                            offset.warm_build.median, offset.warm_build.noise_percent());
    }
    return text;
}

std::string target_cell(const ConvergeResult& result, const TargetTime& time) {
    if (time.below_floor) return "below the floor";
    if (!time.point) return "not reached";
    const ConvergeCase& of = result.points[*time.point].asked;
    return fmt::format("{:.4f} {}{}", time.seconds, to_string(of.aa),
                       of.double_precision ? " d" : "");
}

std::string targets_text(const ConvergeResult& result) {
    std::string text =
        "\nseconds to reach an RMSE, with the fastest setting measured (d: double)\n";
    text += fmt::format("{:<16}", "device");
    for (const double target : rmse_targets) text += fmt::format(" {:<20.0e}", target);
    std::string device;
    for (const TargetTime& time : target_times(result)) {
        if (time.device != device) {
            device = time.device;
            const bool is_cl = time.device_name != "threads";
            text += fmt::format("\n{:<16}",
                                (device + (is_cl ? " " + time.device_name : "")).substr(0, 16));
        }
        text += fmt::format(" {:<20}", target_cell(result, time));
    }
    return text + "\n";
}

}  // namespace

std::string converge_text(const ConvergeResult& result) {
    const ConvergeReference& reference = result.reference;
    std::string text = fmt::format(
        "{} {}x{}, {} rounds after a warm-up{}; load before {:.2f}\n"
        "reference: mean of {} and {} in double, {} bounces\n"
        "its halves differ by RMSE {:.2e}: floor {:.2e}. Errors on values clamped to [0,1].\n\n",
        result.scene_path, result.width, result.height, result.repeats_asked,
        result.interrupted ? ", interrupted" : "", result.load_before, reference.aa_a,
        reference.aa_b, reference.max_bounces, reference.halves_rmse, reference.floor());
    if (const std::string busy = busy_text(load_of(result.load_before)); !busy.empty()) {
        text.insert(0, busy + "\n\n");
    }
    return text + points_text(result) + curves_text(result) + builds_text(result) +
           targets_text(result);
}

}  // namespace rt
