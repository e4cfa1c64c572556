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

/// A picture in the page and how it was rendered; its stats hold the error against the reference,
/// values clamped to [0,1].
struct ReportPicture {
    Picture picture;
    RenderStats stats;
};

/// One scene rendered alternately with the kernels it needs and with everything compiled in.
struct FeatureTrial {
    std::vector<RenderStats> lean, full;
    std::optional<RenderStats> lean_cold, full_cold;  ///< the first of each, with kernels rebuilt
};

/// Everything the page shows about one scene.
struct ReportScene {
    ReportPicture plain, smooth;  ///< one sample a pixel; anti-aliased
    Picture reference;            ///< converged, in double, clamped to [0,1]
    BenchResult bench;
    ConvergeResult converge;
    nlohmann::ordered_json bench_json, converge_json;
    std::optional<FeatureTrial> trial;  ///< empty without an OpenCL device
    bool has_pictures = true;  ///< false when it was stopped before them; then no trial either
    bool complete = true;      ///< false when it was stopped
};

/// Everything the page shows.
struct Report {
    std::vector<ReportScene> scenes;
    std::optional<StressResult> stress;  ///< if --stress was given
    nlohmann::ordered_json environment;
    std::vector<std::string> commands;  ///< that reproduce this page and its parts
    std::string date;                   ///< from the machine's clock, human-readable
    std::string stopped;      ///< what stopped the measurements, in words; empty: they are complete
    double load_before = -1;  ///< one-minute load average; below 0: unknown
};

}  // namespace rt
