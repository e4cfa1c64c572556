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
    std::string renderer;  ///< "threads", an OpenCL device's name, or "naive, ..."
    std::string device;    ///< for --device; empty for naive
    bool double_precision = false;
    bool naive = false;      ///< reported, never judged
    bool judged = true;      ///< whether the bar holds for it
    PictureFigures figures;  ///< of the picture, or summed over those of texts
    std::optional<RayFigures> rays;
    std::size_t refused = 0, rendered = 0;  ///< scene texts
    std::uint64_t hash = 0;                 ///< over every bit of the picture or pictures
    double seconds = 0;  ///< of tracing (a picture's `seconds.trace`), or of the whole trial
    std::string why;     ///< what is broken; empty when nothing is

    bool passed() const { return !judged || why.empty(); }
};

struct StressCaseResult {
    std::string label;
    double value = 0;
    StressBar bar;
    std::vector<StressRow> rows;
    std::string disagreement;  ///< of devices that should give the same bits; empty: none
    double reference_seconds = 0;

    bool passed() const;
};

/// The worst picture of a case beside what it should be.
struct StressShot {
    std::string label;
    Picture worst, reference;
    double badness = -1;
};

struct StressFamilyResult {
    std::string name, parameter, why;
    std::vector<StressCaseResult> cases;
    std::optional<StressShot> shot;  ///< of its worst case, where pictures are kept

    bool passed() const;
};

/// What robust arithmetic costs: medians of tracing the same picture, turn by turn.
struct StressCost {
    std::string scene;
    double robust_seconds = 0, naive_seconds = 0;

    double ratio() const { return naive_seconds > 0 ? robust_seconds / naive_seconds : 0; }
};

/// The time of one picture with one technique, or all of them ("all"), as a textbook has it.
struct TechniqueCost {
    std::string technique, naive;
    double seconds = 0;
};

/// What each technique costs on one scene and renderer, in float: seconds of the fastest of
/// `repeats` pictures, timed turn by turn. On CPUs those of all cores together, which other
/// programs on the machine disturb least.
struct CostTable {
    std::string scene, renderer, device;
    int width = 0, height = 0, repeats = 0;
    std::string aa;
    bool of_processor = false;  ///< seconds of processor time, not of the clock
    double robust_seconds = 0;
    std::vector<TechniqueCost> rows;

    double ratio(const TechniqueCost& row) const {
        return row.seconds > 0 ? robust_seconds / row.seconds : 0;
    }
};

struct StressResult {
    double load_before = 0;
    double seconds = 0;
    bool quick = false, interrupted = false;
    std::vector<StressFamilyResult> families;
    std::optional<StressCost> cost;
    std::vector<CostTable> costs;

    bool passed() const;
};

/// The worst of a family's rows, judged or naive ones.
PictureFigures worst_figures(const StressFamilyResult& family, bool naive);

}  // namespace rt
