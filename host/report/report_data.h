// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/measure/bench_result.h"
#include "host/measure/converge_result.h"
#include "host/picture/render_stats.h"
#include "host/stress/stress_result.h"

namespace rt {

/// A picture in the page, with how it came to be; its stats hold the error against the reference,
/// values clamped to [0,1].
struct ReportPicture {
    Picture picture;
    RenderStats stats;
};

/// One scene rendered interleaved with the kernels it needs and with everything compiled in.
struct FeatureTrial {
    std::vector<RenderStats> lean, full;
    std::optional<RenderStats> lean_cold, full_cold;  ///< the first of each, kernels built again
};

/// All that the page tells about one scene.
struct ReportScene {
    ReportPicture plain, smooth;  ///< one sample a pixel; anti-aliased
    Picture reference;            ///< converged, in double, clamped to [0,1]
    BenchResult bench;
    ConvergeResult converge;
    nlohmann::ordered_json bench_json, converge_json;
    std::optional<FeatureTrial> trial;  ///< empty without an OpenCL device
    bool has_pictures = true;           ///< false when it was stopped before; no trial then either
    bool complete = true;               ///< false when it was stopped
};

/// All that the page tells.
struct Report {
    std::vector<ReportScene> scenes;
    std::optional<StressResult> stress;  ///< where --stress asked for it
    nlohmann::ordered_json environment;
    std::vector<std::string> commands;  ///< that make this page, and its parts, again
    std::string date;                   ///< of the machine's clock, for people
    std::string stopped;      ///< what stopped the measurements, in words; empty: they are complete
    double load_before = -1;  ///< one-minute load average; below 0: unknown
};

}  // namespace rt
