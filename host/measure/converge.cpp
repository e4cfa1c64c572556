// SPDX-License-Identifier: Apache-2.0
#include "host/measure/converge.h"

#include <algorithm>

namespace rt {

namespace {

double rmse_of(const RenderStats& run) { return run.error ? run.error->rmse : 0; }
double build_of(const RenderStats& run) { return run.phases.renderer.build; }
double open_of(const RenderStats& run) { return run.phases.renderer.open; }

bool same_build(const ConvergeCase& a, const ConvergeCase& b) {
    return a.device == b.device && a.double_precision == b.double_precision &&
           a.fast_math == b.fast_math;
}

std::string family_of(const AaMode& aa) {
    const std::string text = to_string(aa);
    return text == "none" ? "grid" : text.substr(0, text.find(':'));
}

/// Costs of the points at these indices.
std::vector<Cost> costs_of(const ConvergeResult& result, const std::vector<std::size_t>& points) {
    std::vector<Cost> costs;
    for (const std::size_t i : points) {
        const auto figures = figures_of(result, result.points[i]);
        costs.push_back({figures->seconds.median, figures->rmse});
    }
    return costs;
}

std::vector<std::size_t> measured_points(const ConvergeResult& result) {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        if (figures_of(result, result.points[i])) points.push_back(i);
    }
    return points;
}

TargetTime target_time(const ConvergeResult& result, const ConvergeCase& of, double target) {
    TargetTime time{
        of.device, of.device_name, target, std::nullopt, 0, target < result.reference.floor()};
    for (const std::size_t i : measured_points(result)) {
        const auto figures = figures_of(result, result.points[i]);
        if (result.points[i].asked.device != of.device || figures->rmse > target) continue;
        if (time.point && figures->seconds.median >= time.seconds) continue;
        time.point = i;
        time.seconds = figures->seconds.median;
    }
    return time;
}

}  // namespace

std::optional<PointFigures> figures_of(const ConvergeResult& result, const ConvergePoint& point) {
    if (!point.has_figures()) return std::nullopt;
    PointFigures figures;
    figures.seconds = spread_of(point.repeats, picture_seconds);
    figures.rmse = spread_of(point.repeats, rmse_of).median;
    figures.below_floor = figures.rmse < result.reference.floor();
    return figures;
}

std::vector<std::size_t> front_of(const ConvergeResult& result) {
    const std::vector<std::size_t> points = measured_points(result);
    std::vector<std::size_t> front;
    for (const std::size_t i : pareto_front(costs_of(result, points))) front.push_back(points[i]);
    return front;
}

std::vector<Curve> curves_of(const ConvergeResult& result) {
    std::vector<Curve> curves;
    for (const std::size_t i : measured_points(result)) {
        const ConvergeCase& asked = result.points[i].asked;
        const std::string family = family_of(asked.aa);
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) {
            return same_build(c.of, asked) && c.of.max_bounces == asked.max_bounces &&
                   c.family == family;
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
        const bool known = std::any_of(offsets.begin(), offsets.end(), [&](const BuildOffset& o) {
            return same_build(o.of, first.asked);
        });
        if (known || first.warm_up.empty()) continue;
        std::vector<RenderStats> repeats;
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

std::vector<TargetTime> target_times(const ConvergeResult& result) {
    std::vector<TargetTime> times;
    for (const ConvergePoint& point : result.points) {
        const bool known = std::any_of(times.begin(), times.end(), [&](const TargetTime& t) {
            return t.device == point.asked.device;
        });
        if (known) continue;
        for (const double target : rmse_targets) {
            times.push_back(target_time(result, point.asked, target));
        }
    }
    return times;
}

}  // namespace rt
