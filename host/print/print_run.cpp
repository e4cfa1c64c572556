// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_run.h"

#include <fmt/ranges.h>

#include <utility>

#include "host/base/text.h"
#include "host/base/version.h"

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

namespace {

constexpr std::size_t device_columns = 19;

/// The heading of a group of rows.
std::string group_of(const BenchCase& asked) {
    const PictureSpec& picture = asked.picture;
    return fmt::format("{} {}x{}, {}, {} filter, {}", printable(asked.scene.path), picture.width,
                       picture.height, to_string(picture.aa), to_string(picture.filter),
                       to_string(picture.precision));
}

/// What is known of the error of the rows' picture, apart from rounding.
std::string estimate_line(const BenchResult& result, const BenchCase& asked) {
    for (const ReferenceRun& run : result.references) {
        if (run.scene.hash == asked.scene.hash && run.picture.aa == asked.picture.aa &&
            run.picture.region == asked.picture.region && run.estimate) {
            return fmt::format("  sampling error: {}\n", to_string(*run.estimate));
        }
    }
    return "";
}

std::string device_text(const BenchCase& asked) {
    std::string text = asked.device;
    text += " " + (asked.uses_threads() ? asked.schedule : short_device_name(asked.device_name));
    return text.substr(0, device_columns);
}

/// Three digits at most, and two behind the point: "0.04", "1.95", "14.7", "104".
std::string ratio_cell(const std::optional<double>& ratio) {
    if (!ratio) return "-";
    const int digits = *ratio < 9.995 ? 2 : *ratio < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f}", *ratio, digits);
}

std::string row_text(const BenchRow& row) {
    const std::string head = fmt::format(" {:<19}", device_text(row.asked));
    const auto& figures = row.figures;
    if (!figures) {
        const bool timed = row.verdict == Verdict::right || row.verdict == Verdict::unfinished;
        return head +
               (timed ? " not finished"
                      : fmt::format(" {}, not timed: {}", to_string(row.verdict), row.why)) +
               "\n";
    }
    const auto& error = row.repeats.back().error;
    return head +
           fmt::format(" {:>8.5f} {:>3.0f} {:>8.5f} {:>3.0f} {:>6.2f} {:>5} {:>5} {:>6} {:>7.1e}\n",
                       figures->trace.median, figures->trace.noise_percent(), figures->total.median,
                       figures->total.noise_percent(), figures->rays_per_second / 1e6,
                       ratio_cell(figures->trace_speed_up), ratio_cell(figures->speed_up),
                       ratio_cell(figures->amdahl), error ? error->rmse : 0);
}

std::string header_text() {
    return fmt::format("{:>65}\n", "speed-up of") +
           fmt::format(" {:<19} {:>8} {:>3} {:>8} {:>3} {:>6} {:>5} {:>5} {:>6} {:>7}\n", "device",
                       "trace s", "+-%", "total s", "+-%", "Mray/s", "trace", "total", "Amdahl",
                       "RMSE");
}

constexpr const char* legend =
    "Medians; +-%: median absolute deviation. total: flatten, open, build, upload,\n"
    "trace, resolve, read back. speed-up: relative to one thread with the same\n"
    "schedule (devices: tiles). Amdahl: predicted speed-up of total, 1/((1-f)+f/n),\n"
    "f = trace/total of one thread. scalar: one ray at a time. RMSE: relative to the\n"
    "same samples in double, clamped to [0,1].\n";

}  // namespace

std::string bench_text(const BenchResult& result) {
    std::string text = busy_text(result.load_before), group;
    if (!text.empty()) text += "\n\n";
    for (const BenchRow& row : result.rows) {
        if (const std::string next = group_of(row.asked); next != group) {
            text += (group.empty() ? "" : "\n") + next + "\n" + estimate_line(result, row.asked) +
                    header_text();
            group = next;
        }
        text += row_text(row);
    }
    text += fmt::format("\n{}; other load {:.2f}\n{}",
                        rounds_text(result.rows, result.repeats_asked, result.interrupted),
                        result.load_before, legend);
    return text;
}

namespace {

std::string reference_text(const ConvergeReference& reference) {
    if (reference.halves.empty()) {
        return reference.file.empty() ? "reference: not finished\n\n"
                                      : fmt::format(
                                            "reference: {}, whose own error is unknown; "
                                            "values clamped to [0,1]\n\n",
                                            printable(reference.file));
    }
    return fmt::format(
        "reference: mean of {} in double, {} bounces\n"
        "its halves differ by RMSE {:.2e}: floor {:.2e}; values clamped to [0,1]\n\n",
        printable(fmt::format("{}", fmt::join(reference.halves, " and "))), reference.max_bounces,
        reference.halves_rmse, reference.floor());
}

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
    std::string text = fmt::format(
        "{}\n{}x{}, {}; other load {:.2f}\n{}", printable(result.scene.path), result.width,
        result.height, rounds_text(result.points, result.repeats_asked, result.interrupted),
        result.load_before, reference_text(result.reference));
    if (const std::string busy = busy_text(result.load_before); !busy.empty()) {
        text.insert(0, busy + "\n\n");
    }
    return text + points_text(result) + curves_text(result) + builds_text(result) +
           targets_text(result);
}

namespace {

std::string row_name(const StressRow& row) {
    return fmt::format("{} {}", row.renderer, to_string(row.precision));
}

std::string row_figures(const StressRow& row) {
    if (row.rays) {
        return fmt::format("{} of {} rays fail, {:.1e}", row.rays->failures, row.rays->rays,
                           row.rays->max_error);
    }
    const PictureFigures& figures = row.figures;
    std::string text = fmt::format("{} wrong ({} at edges), {:.1e}", figures.wrong,
                                   figures.wrong_at_edges, figures.max_error);
    if (figures.nans > 0) text += fmt::format(", {} NaN", figures.nans);
    if (figures.infinities > 0) text += fmt::format(", {} inf", figures.infinities);
    return text;
}

/// Of the row, among those that are judged, in which most is wrong.
std::string family_figures(const StressFamilyResult& family) {
    const auto badness = [](const StressRow& row) {
        return row.rays ? std::pair<std::size_t, double>(row.rays->failures, row.rays->max_error)
                        : std::pair(row.figures.wrong, row.figures.max_error);
    };
    const StressRow* worst = nullptr;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (row.judged && (!worst || badness(row) > badness(*worst))) worst = &row;
        }
    }
    return worst ? row_figures(*worst) : "not judged";
}

std::string row_verdict(const StressRow& row) {
    if (!row.judged) return "not judged";
    return row.why.empty() ? "pass" : "FAIL: " + row.why;
}

/// A line per row that failed; verbose: per row.
std::string case_lines(const StressCaseResult& one, bool verbose) {
    std::string text;
    for (const StressRow& row : one.rows) {
        if (row.passed() && !verbose) continue;
        text += fmt::format("  {:<24} {:<44} {:<40} {:>8.4f} s  {}\n", one.label, row_name(row),
                            row_figures(row), row.seconds, row_verdict(row));
    }
    if (!one.disagreement.empty()) {
        text += fmt::format("  {:<24} FAIL: {}\n", one.label, one.disagreement);
    }
    return text;
}

std::string family_lines(const StressFamilyResult& family, bool verbose) {
    std::string text = fmt::format("{:<4} {:<20} {}\n", family.passed() ? "pass" : "FAIL",
                                   family.name, family_figures(family));
    if (verbose) text += fmt::format("     {}\n", family.why);
    for (const StressCaseResult& one : family.cases) text += case_lines(one, verbose);
    return text;
}

}  // namespace

std::string stress_text(const StressResult& result, bool verbose) {
    const auto passed = std::ranges::count_if(result.families, &StressFamilyResult::passed);
    const bool has_failed = passed < std::ssize(result.families) || !result.interrupted;
    std::string text = fmt::format("{}: {} of {} families, {:.0f} s{}\n",
                                   result.passed() ? "PASS" : (has_failed ? "FAIL" : "STOPPED"),
                                   passed, result.families.size() + result.unfinished,
                                   result.seconds, result.interrupted ? ", interrupted" : "");
    for (const StressFamilyResult& family : result.families) {
        text += family_lines(family, verbose);
    }
    return text;
}

std::string stress_list(const std::vector<StressFamily>& families) {
    std::string text;
    for (const StressFamily& family : families) {
        text += fmt::format("{}: {}\n", family.name, family.why);
        for (const StressCase& one : family.cases) {
            text += fmt::format("  {}/{}{}\n", family.name, one.label, one.quick ? "  quick" : "");
        }
    }
    return text;
}

}  // namespace rt
