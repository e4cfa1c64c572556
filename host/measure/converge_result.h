// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench_result.h"
#include "host/picture/render_stats.h"

namespace rt {

/// What a point of `mirrorball converge` asks for.
struct ConvergeCase {
    std::string device;       ///< spec for --device: "threads", "0"
    std::string device_name;  ///< "threads", or the OpenCL device's own name
    AaMode aa;
    bool double_precision = false, fast_math = false;
    int max_bounces = 0;
};

/// A point of the error-time plane and its runs. RenderStats::error is against the
/// converged reference, on values clamped to [0,1].
struct ConvergePoint : TimedRuns {
    ConvergeCase asked;
};

/// The converged picture: the mean of two independent halves, in double with strict arithmetic.
struct ConvergeReference {
    std::string aa_a, aa_b;  ///< how the halves were sampled
    int max_bounces = 0;
    std::uint64_t hash_a = 0, hash_b = 0;  ///< of the halves' bytes as float
    double halves_rmse = 0;                ///< between the halves, clamped to [0,1]
    bool from_cache = false;
    double seconds = 0;      ///< to render the halves, or to read them from the cache
    std::string cache_path;  ///< of half a; empty when nothing could be cached

    /// The reference's own RMSE, estimated: errors of independent halves add in quadrature, so
    /// their mean is off by half their difference. Below it, nothing can be said about a picture.
    double floor() const { return halves_rmse / 2; }
};

/// All results of `mirrorball converge`. Figures are computed from it (converge.h).
struct ConvergeResult {
    std::string scene_path, scene_name;
    std::vector<std::string> notes;  ///< Scene::notes
    std::uint64_t scene_hash = 0;
    int width = 0, height = 0;  ///< pixels
    int repeats_asked = 0;
    bool interrupted = false;
    double load_before = -1;  ///< see other_load
    ConvergeReference reference;
    std::vector<ConvergePoint> points;  ///< by device, precision, math, bounces; then AA
};

}  // namespace rt
