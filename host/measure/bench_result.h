// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/base/text.h"
#include "host/picture/render_stats.h"

namespace rt {

/// Outcome of a case.
enum class Verdict {
    right,       ///< every picture agrees with the reference
    wrong,       ///< a picture does not: no timing is given
    failed,      ///< the device could not render it
    unfinished,  ///< stopped before the first repeat was done
};

inline constexpr Named<Verdict> verdict_names[] = {{"right", Verdict::right},
                                                   {"wrong", Verdict::wrong},
                                                   {"failed", Verdict::failed},
                                                   {"unfinished", Verdict::unfinished}};

inline const char* to_string(Verdict verdict) { return name_of(verdict_names, verdict); }

/// Every run of a case, and their outcome.
struct TimedRuns {
    std::vector<RenderStats> warm_up;  ///< the first round, kept separately; not used in any figure
    std::vector<RenderStats> repeats;  ///< one per round, in order
    Verdict verdict = Verdict::unfinished;
    std::string why;  ///< what is wrong or what failed; empty when right

    bool has_figures() const { return verdict == Verdict::right && !repeats.empty(); }
};

/// What a row of `mirrorball bench` asks for.
struct BenchCase {
    std::string scene_path, scene_name;
    std::uint64_t scene_hash = 0;
    int width = 0, height = 0;  ///< pixels
    AaMode aa;
    bool double_precision = false;
    bool uses_threads = false;  ///< pthreads; else OpenCL
    std::string device;         ///< spec for --device: "threads:2", "0"
    std::string device_name;    ///< "threads", or the OpenCL device's own name
    int threads = 0;            ///< asked for; 0 for OpenCL
    std::string schedule;       ///< "tiles", "buffers" or "scalar" (tiles, one ray at a time);
                                ///< empty for OpenCL
    std::string change;         ///< in an ablation: what differs from the usual; empty: nothing
};

/// A row: one case and its runs. RenderStats::error is against the double reference, on
/// values clamped to [0,1]. RenderStats::phases.start and .write are 0, .total is timed_total().
struct BenchRow : TimedRuns {
    BenchCase asked;
};

/// All results of `mirrorball bench`. Figures are computed from it (bench.h).
struct BenchResult {
    int repeats_asked = 0;
    bool interrupted = false;
    double load_before = -1;              ///< see other_load
    std::vector<RenderStats> references;  ///< double, strict, threads; one per scene, size, AA mode
    std::vector<BenchRow> rows;           ///< by scene, size, AA, precision; then devices
    /// With --ablate (`rows` is then empty): a picture on a device as usual, then with each change.
    /// Every picture must have the same bits as the usual one.
    std::vector<BenchRow> ablation;
};

}  // namespace rt
