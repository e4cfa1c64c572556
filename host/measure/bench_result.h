// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/picture/render_stats.h"

namespace rt {

/// Outcome of a row.
enum class Verdict {
    right,       ///< every picture agrees with the reference
    wrong,       ///< a picture does not: no timing is given
    failed,      ///< the device could not render it
    unfinished,  ///< stopped before the first repeat was done
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

/// A row: one case, with every run kept. RenderStats::error is against the double reference, on
/// values clamped to [0,1]. RenderStats::phases.start and .write are 0, .total is timed_total().
struct BenchRow {
    BenchCase asked;
    std::vector<RenderStats> warm_up;  ///< the first round, kept separately; not used in any figure
    std::vector<RenderStats> repeats;  ///< one per round, in order
    Verdict verdict = Verdict::unfinished;
    std::string why;  ///< what is wrong or what failed; empty when right
};

/// All results of `mirrorball bench`. Figures are computed from it (bench.h).
struct BenchResult {
    int repeats_asked = 0;
    bool interrupted = false;
    double load_before = -1;  ///< one-minute load average when it began; below 0: unknown
    std::vector<RenderStats> references;  ///< double, strict, threads; one per scene, size, AA mode
    std::vector<BenchRow> rows;           ///< by scene, size, AA, precision; then devices
    /// With --ablate (`rows` is then empty): a picture on a device as usual, then with each change.
    /// Every picture must have the same bits as the usual one.
    std::vector<BenchRow> ablation;
};

}  // namespace rt
