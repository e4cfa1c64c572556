// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/converge_result.h"
#include "host/measure/pareto.h"
#include "host/measure/statistics.h"

namespace rt {

/// The RMSEs that "seconds to reach" are given for.
inline constexpr std::array<double, 4> rmse_targets{1e-2, 3e-3, 1e-3, 3e-4};

/// Figures of a right point.
struct PointFigures {
    Spread seconds;            ///< picture_seconds: without open and build
    double rmse = 0;           ///< median over the repeats (equal in strict arithmetic)
    bool below_floor = false;  ///< closer to the reference than the reference's estimated error
};

/// Empty unless the point is right and has a repeat.
std::optional<PointFigures> figures_of(const ConvergeResult& result, const ConvergePoint& point);

/// Indices into ConvergeResult::points of the Pareto front, by increasing seconds.
std::vector<std::size_t> front_of(const ConvergeResult& result);

/// Points that differ only in sampling, in sweep order.
struct Curve {
    ConvergeCase of;     ///< its device, precision, math and bounces
    std::string family;  ///< "grid" (with none), "sobol", "adaptive"
    std::vector<std::size_t> points;
    std::optional<double> slope;  ///< of log RMSE over log seconds; none for a single point
};

std::vector<Curve> curves_of(const ConvergeResult& result);

/// Extra seconds of a device's first picture.
struct BuildOffset {
    ConvergeCase of;         ///< its device, precision and math
    double open = 0;         ///< median
    double first_build = 0;  ///< of the first picture, with an empty kernel cache
    Spread warm_build;       ///< over all repeats
};

std::vector<BuildOffset> build_offsets(const ConvergeResult& result);

/// How soon a device reaches an RMSE, with the fastest measured setting that does.
struct TargetTime {
    std::string device, device_name;
    double target = 0;
    std::optional<std::size_t> point;  ///< empty when no setting reached it
    double seconds = 0;                ///< its median picture_seconds
    bool below_floor = false;          ///< the target itself is below the floor: undecidable
};

/// Devices in the order of the points; targets from the largest down.
std::vector<TargetTime> target_times(const ConvergeResult& result);

}  // namespace rt
