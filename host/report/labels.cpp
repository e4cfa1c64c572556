// SPDX-License-Identifier: Apache-2.0
#include "host/report/labels.h"

#include <fmt/format.h>

#include "host/base/text.h"
#include "host/report/plot_axis.h"

namespace rt {

namespace {

std::string opencl_label(const std::string& platform, const std::string& name) {
    return platform == "Portable Computing Language" ? "PoCL" : name;
}

}  // namespace

std::string device_label(const BenchRow& row) {
    const BenchCase& asked = row.asked;
    if (asked.uses_threads) {
        return fmt::format("{}{}", counted(asked.threads, "thread"),
                           asked.schedule == "buffers"  ? ", sample buffers"
                           : asked.schedule == "scalar" ? ", one ray at a time"
                                                        : "");
    }
    return row.repeats.empty() ? asked.device_name : device_label(row.repeats.front());
}

std::string device_label(const RenderStats& run) {
    return run.device.schedule.empty() ? opencl_label(run.device.platform, run.device.name)
                                       : run.device.name;
}

std::string size_text(int width, int height) {
    return fmt::format("{}\u00a0x\u00a0{}", width, height);
}

std::string sampling_text(const AaMode& aa) {
    if (aa.samples() == 1 && !aa.refines()) return "one sample per pixel";
    const bool is_grid = aa.pattern == AaMode::Pattern::grid;
    return fmt::format("{} ({})",
                       aa.refines()
                           ? "more samples where neighbors differ"
                           : (is_grid ? size_text(aa.count, aa.count) : std::to_string(aa.count)) +
                                 " samples per pixel",
                       to_string(aa));
}

std::string spread_text(const Spread& spread) {
    return fmt::format("{} ± {}\u00a0%", duration_text(spread.median),
                       significant(spread.noise_percent(), 2));
}

std::string milliseconds(double seconds) { return significant(seconds * 1e3, 3); }

}  // namespace rt
