// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "host/base/text.h"
#include "host/measure/machine_load.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

/// "0 PoCL (AMD EPYC 7763)"
std::string device_text(const std::string& device, const std::string& name) {
    return name == "threads" ? device : device + " " + short_device_name(name);
}

/// "0 PoCL (AMD EPYC float  strict"
std::string who(const ConvergeCase& of) {
    return fmt::format("{:<16} {:<6} {:<6}", device_text(of.device, of.device_name).substr(0, 16),
                       to_string(of.picture.precision), to_string(of.picture.math));
}

/// The heading of the points of one setting.
std::string group_of(const ConvergeCase& of) {
    return fmt::format("{}, {}, {}, {}", device_text(of.device, of.device_name),
                       to_string(of.picture.precision),
                       of.picture.math == Math::fast ? "fast math" : "strict",
                       counted(of.picture.max_bounces, "bounce"));
}

std::string point_text(const ConvergePoint& point, bool on_front) {
    const std::string head = fmt::format("  {:<16}", to_string(point.asked.picture.aa));
    const auto& figures = point.figures;
    if (!figures) return fmt::format("{} {} {}\n", head, to_string(point.verdict), point.why);
    const auto& about = point.estimate;
    const std::string promised = !about                ? ""
                                 : about->known_rmse() ? fmt::format("{:.2e}", about->rmse)
                                                       : fmt::format("<{:.2e}", about->high);
    return fmt::format("{} {:>9.5f} {:>4.1f} {:>9.5f} {:>9.2e} {:>9} {}{}\n", head,
                       figures->seconds.median, figures->seconds.noise_percent(),
                       figures->seconds.max, figures->rmse, promised, on_front ? "*" : " ",
                       figures->below_floor ? "<" : "");
}

std::string points_text(const ConvergeResult& result) {
    std::string text, group;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        if (const std::string next = group_of(result.points[i].asked); next != group) {
            text += fmt::format("{}\n  {:<16} {:>9} {:>4} {:>9} {:>9} {:>9}\n", next, "AA",
                                "seconds", "+-%", "slowest", "RMSE", "estimate");
            group = next;
        }
        const bool on_front = std::ranges::count(result.front, i) > 0;
        text += point_text(result.points[i], on_front);
    }
    return text +
           "* on the Pareto front; < below the reference's own error, not resolved.\n"
           "seconds: medians without open and build; +-%: median absolute deviation.\n"
           "estimate: what 'render --estimate' says of the RMSE.\n";
}

std::string curves_text(const ConvergeResult& result) {
    std::string text = "\nslope of log RMSE over log seconds\n";
    for (const Curve& curve : result.curves) {
        if (!curve.slope) continue;
        text += fmt::format("{} {:<10} {:<10} {:>6.2f}\n", who(curve.of),
                            counted(curve.of.picture.max_bounces, "bounce"), curve.family,
                            *curve.slope);
    }
    return text;
}

std::string builds_text(const ConvergeResult& result) {
    std::string text = fmt::format(
        "\n"
        "extra time for the first picture, seconds\n"
        "{:<30} {:>9} {:>11} {:>11} {:>4}\n",
        "", "open", "first build", "later build", "+-%");
    for (const BuildOffset& offset : result.builds) {
        text += fmt::format("{} {:>9.5f} {:>11.5f} {:>11.5f} {:>4.1f}\n", who(offset.of),
                            offset.open, offset.first_build, offset.warm_build.median,
                            offset.warm_build.noise_percent());
    }
    return text;
}

std::string target_text(const ConvergeResult& result, const TargetTime& time) {
    if (time.below_floor) return "below the floor";
    if (!time.point) return "not reached";
    const ConvergeCase& of = result.points[*time.point].asked;
    return fmt::format("{:>8.4f} s  {}{}", *time.seconds, to_string(of.picture.aa),
                       of.picture.precision == Precision::float64 ? " in double" : "");
}

std::string targets_text(const ConvergeResult& result) {
    std::string text = "\ntime to reach an RMSE, with the fastest setting that reaches it\n";
    for (const TargetTime& time : result.targets) {
        text += fmt::format("{:<24} {:>5.0e}  {}\n",
                            device_text(time.device, time.device_name).substr(0, 24), time.target,
                            target_text(result, time));
    }
    return text;
}

}  // namespace

std::string converge_text(const ConvergeResult& result) {
    const ConvergeReference& reference = result.reference;
    std::string text = fmt::format(
        "{}\n{}x{}, {}; other load {:.2f}\n"
        "reference: mean of {} and {} in double, {} bounces\n"
        "its halves differ by RMSE {:.2e}: floor {:.2e}; values clamped to [0,1]\n\n",
        printable(result.scene.path), result.width, result.height,
        rounds_text(result.points, result.repeats_asked, result.interrupted), result.load_before,
        reference.aa_a, reference.aa_b, reference.max_bounces, reference.halves_rmse,
        reference.floor());
    if (const std::string busy = busy_text(result.load_before); !busy.empty()) {
        text.insert(0, busy + "\n\n");
    }
    return text + points_text(result) + curves_text(result) + builds_text(result) +
           targets_text(result);
}

}  // namespace rt
