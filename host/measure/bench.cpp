// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/text.h"
#include "host/measure/amdahl.h"

namespace rt {

namespace {

bool same_picture(const BenchCase& a, const BenchCase& b) {
    return a.scene_path == b.scene_path && a.scene_hash == b.scene_hash && a.width == b.width &&
           a.height == b.height && a.aa == b.aa && a.double_precision == b.double_precision;
}

const BenchRow* one_thread_row(const BenchResult& result, const BenchCase& asked,
                               const std::string& schedule) {
    const auto row = std::find_if(result.rows.begin(), result.rows.end(), [&](const BenchRow& r) {
        return r.has_figures() && r.asked.uses_threads && r.asked.threads == 1 &&
               r.asked.schedule == schedule && same_picture(r.asked, asked);
    });
    return row == result.rows.end() ? nullptr : &*row;
}

const BenchRow* base_of(const BenchResult& result, const BenchCase& asked) {
    if (asked.uses_threads) return one_thread_row(result, asked, asked.schedule);
    const BenchRow* const tiles = one_thread_row(result, asked, "tiles");
    return tiles != nullptr ? tiles : one_thread_row(result, asked, "buffers");
}

}  // namespace

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
    if (!row.asked.uses_threads) return figures;
    figures.parallel_fraction = parallel_fraction(base_trace, base_total);
    figures.amdahl = amdahl_speed_up(*figures.parallel_fraction, figures.threads);
    figures.over_amdahl = *figures.speed_up - *figures.amdahl;
    return figures;
}

const BenchRow& usual_row(const BenchResult& result, const BenchRow& row) {
    std::ptrdiff_t i = &row - result.ablation.data();
    while (!result.ablation[static_cast<std::size_t>(i)].asked.change.empty()) --i;
    return result.ablation[static_cast<std::size_t>(i)];
}

std::optional<AblationFigures> ablation_figures(const BenchResult& result, const BenchRow& row) {
    const BenchRow& usual = usual_row(result, row);
    if (!row.has_figures() || !usual.has_figures()) return std::nullopt;
    AblationFigures figures;
    figures.trace = spread_of(row.repeats, trace_seconds);
    if (!row.warm_up.empty()) figures.first_build = row.warm_up.front().phases.renderer.build;
    const double before = spread_of(usual.repeats, trace_seconds).median;
    if (before > 0) figures.ratio = figures.trace.median / before;
    return figures;
}

void judge_ablation(BenchResult& result) {
    for (BenchRow& row : result.ablation) {
        const BenchRow& usual = usual_row(result, row);
        if (!row.has_figures() || usual.repeats.empty()) continue;
        const std::uint64_t found = row.repeats.front().image_hash;
        const std::uint64_t expected = usual.repeats.front().image_hash;
        if (found == expected) continue;
        row.verdict = Verdict::wrong;
        row.why = fmt::format("image {}, but the default row's is {}", hash_text(found),
                              hash_text(expected));
    }
}

std::string key_of(const BenchCase& asked) {
    return fmt::format("{} {}x{} {} {} {} {}{}{}", hash_text(asked.scene_hash), asked.width,
                       asked.height, to_string(asked.aa), precision_name(asked.double_precision),
                       asked.device, asked.uses_threads ? "" : asked.device_name,
                       asked.schedule.empty() ? "" : " ", asked.schedule);
}

bool any_row(const BenchResult& result, Verdict verdict) {
    const auto has_it = [&](const BenchRow& row) { return row.verdict == verdict; };
    return std::any_of(result.rows.begin(), result.rows.end(), has_it) ||
           std::any_of(result.ablation.begin(), result.ablation.end(), has_it);
}

}  // namespace rt
