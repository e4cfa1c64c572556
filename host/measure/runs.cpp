// SPDX-License-Identifier: Apache-2.0
#include "host/measure/runs.h"

#include <algorithm>
#include <cmath>

namespace rt {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double median_absolute_deviation(const std::vector<double>& values) {
    const double middle = median(values);
    std::vector<double> distances;
    for (const double value : values) distances.push_back(std::fabs(value - middle));
    return median(std::move(distances));
}

Spread spread_of(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    return {median(values), median_absolute_deviation(values), *min, *max};
}

Spread spread_of(std::span<const TimedRun> runs,
                 const std::function<double(const RenderStats&)>& figure) {
    std::vector<double> values;
    for (const RenderStats& run : runs) values.push_back(figure(run));
    return spread_of(values);
}

double timed_total(const RenderStats& run) {
    return run.phases.renderer.open + run.phases.renderer.build + picture_seconds(run);
}

double picture_seconds(const RenderStats& run) {
    const RendererTimes& times = run.phases.renderer;
    return run.phases.flatten + times.upload + times.trace + times.resolve + times.read_back;
}

double trace_seconds(const RenderStats& run) { return run.phases.renderer.trace; }

}  // namespace rt
