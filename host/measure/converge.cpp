// SPDX-License-Identifier: Apache-2.0
#include "host/measure/converge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rt {

namespace {

double rmse_of(const RenderStats& run) { return run.error ? run.error->rmse : 0; }
double build_of(const RenderStats& run) { return run.phases.renderer.build; }
double open_of(const RenderStats& run) { return run.phases.renderer.open; }

bool same_build(const ConvergeCase& a, const ConvergeCase& b) {
    return a.device == b.device && a.picture.precision == b.picture.precision &&
           a.picture.math == b.picture.math;
}

std::string family_of(const AaMode& aa) {
    const std::string text = to_string(aa);
    return text == "none" ? "grid" : text.substr(0, text.find(':'));
}

/// The value rounded to the three digits that tables show: what nobody sees decides nothing.
double shown(double value) {
    if (!(value > 0) || !std::isfinite(value)) return value;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return std::round(value / unit) * unit;
}

std::optional<PointFigures> figures_of(const ConvergePoint& point, double floor) {
    if (!point.has_figures()) return std::nullopt;
    PointFigures figures;
    figures.seconds = spread_of(point.repeats, picture_seconds);
    figures.rmse = spread_of(point.repeats, rmse_of).median;
    figures.below_floor = figures.rmse < floor;
    return figures;
}

std::vector<std::size_t> measured_points(const ConvergeResult& result) {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        if (result.points[i].figures) points.push_back(i);
    }
    return points;
}

/// Costs of the points at these indices, which have figures.
std::vector<Cost> costs_of(const ConvergeResult& result, const std::vector<std::size_t>& points) {
    std::vector<Cost> costs;
    for (const std::size_t i : points) {
        const PointFigures& figures = *result.points[i].figures;
        costs.push_back({figures.seconds.median, figures.rmse});
    }
    return costs;
}

std::vector<Curve> curves_of(const ConvergeResult& result) {
    std::vector<Curve> curves;
    for (const std::size_t i : measured_points(result)) {
        const ConvergeCase& asked = result.points[i].asked;
        const std::string family = family_of(asked.picture.aa);
        auto curve = std::ranges::find_if(curves, [&](const Curve& c) {
            return same_build(c.of, asked) &&
                   c.of.picture.max_bounces == asked.picture.max_bounces && c.family == family;
        });
        if (curve == curves.end()) curve = curves.insert(curve, Curve{asked, family, {}, {}});
        curve->points.push_back(i);
    }
    for (Curve& curve : curves) curve.slope = log_log_slope(costs_of(result, curve.points));
    return curves;
}

std::vector<BuildOffset> build_offsets(const ConvergeResult& result) {
    std::vector<BuildOffset> offsets;
    for (const ConvergePoint& first : result.points) {
        const auto is_same = [&](const BuildOffset& o) { return same_build(o.of, first.asked); };
        if (std::ranges::any_of(offsets, is_same) || first.warm_up.empty()) continue;
        std::vector<TimedRun> repeats;
        for (const ConvergePoint& point : result.points) {
            if (!same_build(point.asked, first.asked)) continue;
            repeats.insert(repeats.end(), point.repeats.begin(), point.repeats.end());
        }
        const RenderStats& run = first.warm_up.front();
        offsets.push_back({first.asked, spread_of(repeats, open_of).median, build_of(run),
                           spread_of(repeats, build_of)});
    }
    return offsets;
}

TargetTime target_time(const ConvergeResult& result, const ConvergeCase& of, double target) {
    TargetTime time{of.device, of.device_name, target, {}, {}, target < result.reference.floor()};
    for (const std::size_t i : measured_points(result)) {
        const PointFigures& figures = *result.points[i].figures;
        if (result.points[i].asked.device != of.device || figures.rmse > target) continue;
        if (time.seconds && figures.seconds.median >= *time.seconds) continue;
        time.point = i;
        time.seconds = figures.seconds.median;
    }
    return time;
}

std::vector<TargetTime> target_times(const ConvergeResult& result) {
    std::vector<TargetTime> times;
    for (const ConvergePoint& point : result.points) {
        if (std::ranges::count(times, point.asked.device, &TargetTime::device) > 0) continue;
        for (const double target : rmse_targets) {
            times.push_back(target_time(result, point.asked, target));
        }
    }
    return times;
}

}  // namespace

void ConvergeResult::summarize() {
    for (ConvergePoint& point : points) point.figures = figures_of(point, reference.floor());
    const std::vector<std::size_t> measured = measured_points(*this);
    front.clear();
    for (const std::size_t i : pareto_front(costs_of(*this, measured))) {
        front.push_back(measured[i]);
    }
    curves = curves_of(*this);
    builds = build_offsets(*this);
    targets = target_times(*this);
}

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        return std::pair(shown(costs[i].seconds), costs[i].rmse);
    });
    std::vector<std::size_t> front;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order) {
        if (!(shown(costs[i].rmse) < best)) continue;
        best = shown(costs[i].rmse);
        front.push_back(i);
    }
    return front;
}

std::optional<double> log_log_slope(std::span<const Cost> costs) {
    // Relative to the first cost and about the mean: the spread of nearly equal times must not be a
    // small difference of large sums.
    const Cost* first = nullptr;
    std::vector<double> us, vs;
    for (const Cost& cost : costs) {
        if (!(cost.seconds > 0) || !(cost.rmse > 0)) continue;
        if (first == nullptr) first = &cost;
        us.push_back(std::log(cost.seconds / first->seconds));
        vs.push_back(std::log(cost.rmse / first->rmse));
    }
    const double u_mean = std::accumulate(us.begin(), us.end(), 0.0) / us.size();
    const double v_mean = std::accumulate(vs.begin(), vs.end(), 0.0) / vs.size();
    double uu = 0, uv = 0;
    for (std::size_t i = 0; i < us.size(); ++i) {
        uu += (us[i] - u_mean) * (us[i] - u_mean);
        uv += (us[i] - u_mean) * (vs[i] - v_mean);
    }
    if (!(uu > 0)) return std::nullopt;
    return uv / uu;
}

}  // namespace rt
