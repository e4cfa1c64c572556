// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/stress/judge.h"
#include "host/stress/stress_case.h"

namespace rt {

/// One case on one renderer.
struct StressRow {
    std::string renderer;  ///< "threads" or an OpenCL device's name
    std::string device;    ///< for --device
    bool double_precision = false;
    bool judged = true;      ///< whether the tolerance applies to it
    PictureFigures figures;  ///< of the picture, or summed over all scene texts
    std::optional<RayFigures> rays;
    std::size_t refused = 0, rendered = 0;  ///< scene texts
    std::uint64_t hash = 0;                 ///< over every bit of the picture or pictures
    double seconds = 0;  ///< of tracing (a picture's `seconds.trace`), or of the whole trial
    std::string why;     ///< what failed; empty if nothing did

    bool passed() const { return !judged || why.empty(); }
};

struct StressCaseResult {
    std::string label;
    double value = 0;
    StressTolerance tolerance;
    std::vector<StressRow> rows;
    std::string disagreement;  ///< between devices that should give the same bits; empty: none
    double reference_seconds = 0;

    bool passed() const;
};

struct StressFamilyResult {
    std::string name, parameter, why;
    std::vector<StressCaseResult> cases;

    bool passed() const;
};

struct StressResult {
    double load_before = 0;
    double seconds = 0;
    bool quick = false, interrupted = false;
    std::size_t unfinished = 0;  ///< families that an interruption left without a verdict
    std::vector<StressFamilyResult> families;

    bool passed() const;
};

/// The worst figures over a family's judged rows.
PictureFigures worst_figures(const StressFamilyResult& family);

}  // namespace rt
