// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"

#include <fmt/format.h>

#include <algorithm>

namespace rt {

namespace {

bool same_picture(const BenchCase& a, const BenchCase& b) {
    return a.scene.path == b.scene.path && a.scene.hash == b.scene.hash && a.picture == b.picture;
}

const BenchRow* one_thread_row(const BenchResult& result, const BenchCase& asked,
                               const std::string& schedule) {
    const auto row = std::ranges::find_if(result.rows, [&](const BenchRow& r) {
        return r.has_figures() && r.asked.uses_threads() && r.asked.threads == 1 &&
               r.asked.schedule == schedule && same_picture(r.asked, asked);
    });
    return row == result.rows.end() ? nullptr : &*row;
}

const BenchRow* base_of(const BenchResult& result, const BenchCase& asked) {
    if (asked.uses_threads()) return one_thread_row(result, asked, asked.schedule);
    const BenchRow* const tiles = one_thread_row(result, asked, "tiles");
    return tiles != nullptr ? tiles : one_thread_row(result, asked, "buffers");
}

std::optional<BenchFigures> figures_of(const BenchResult& result, const BenchRow& row) {
    if (!row.has_figures()) return std::nullopt;
    BenchFigures figures;
    figures.trace = spread_of(row.repeats, trace_seconds);
    figures.total = spread_of(row.repeats, timed_total);
    const RenderStats& run = row.repeats.front();
    if (figures.trace.median > 0) {
        figures.rays_per_second = static_cast<double>(run.rays.total()) / figures.trace.median;
    }
    figures.threads = run.device.threads;
    const BenchRow* const base = base_of(result, row.asked);
    if (base == nullptr || figures.total.median <= 0) return figures;
    const double base_total = spread_of(base->repeats, timed_total).median;
    const double base_trace = spread_of(base->repeats, trace_seconds).median;
    figures.speed_up = base_total / figures.total.median;
    if (figures.trace.median > 0) figures.trace_speed_up = base_trace / figures.trace.median;
    if (!row.asked.uses_threads()) return figures;
    figures.parallel_fraction = parallel_fraction(base_trace, base_total);
    figures.amdahl = amdahl_speed_up(*figures.parallel_fraction, figures.threads);
    figures.over_amdahl = *figures.speed_up - *figures.amdahl;
    return figures;
}

}  // namespace

void BenchResult::judge() {
    for (BenchRow& row : rows) row.figures = figures_of(*this, row);
}

std::string key_of(const BenchCase& asked) {
    const PictureSpec& picture = asked.picture;
    return fmt::format("{} {}x{} {} {} {} {}{}{}", hash_text(asked.scene.hash), picture.width,
                       picture.height, to_string(picture.aa), to_string(picture.precision),
                       asked.device, asked.uses_threads() ? "" : asked.device_name,
                       asked.schedule.empty() ? "" : " ", asked.schedule);
}

double parallel_fraction(double trace_seconds, double total_seconds) {
    return total_seconds > 0 ? trace_seconds / total_seconds : 0;
}

double amdahl_speed_up(double parallel_fraction, int threads) {
    return 1 / ((1 - parallel_fraction) + parallel_fraction / threads);
}

}  // namespace rt
