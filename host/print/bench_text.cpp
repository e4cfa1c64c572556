// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "host/base/text.h"
#include "host/measure/machine_load.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"

namespace rt {

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

/// Which rows gave which picture; in strict arithmetic they are all the same.
std::string images_text(const std::map<std::string, std::vector<std::string>>& images) {
    std::string text;
    for (const auto& [hash, devices] : images) {
        const bool is_alone = images.size() == 1;
        text += fmt::format("  image {} {}\n", hash,
                            is_alone ? "from all" : fmt::format("{}", fmt::join(devices, ", ")));
    }
    return text;
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
    std::map<std::string, std::vector<std::string>> images;
    for (const BenchRow& row : result.rows) {
        if (const std::string next = group_of(row.asked); next != group) {
            text += images_text(images) + (group.empty() ? "" : "\n") + next + "\n" +
                    estimate_line(result, row.asked) + header_text();
            images.clear();
            group = next;
        }
        text += row_text(row);
        if (row.repeats.empty()) continue;
        const std::string schedule = row.asked.schedule.empty() ? "" : "/" + row.asked.schedule;
        images[hash_text(row.repeats.back().image_hash)].push_back(row.asked.device + schedule);
    }
    text += images_text(images);
    text += fmt::format("\n{}; other load {:.2f}\n{}",
                        rounds_text(result.rows, result.repeats_asked, result.interrupted),
                        result.load_before, legend);
    return text;
}

}  // namespace rt
