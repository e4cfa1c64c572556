// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/journal/shares.h"
#include "host/render/picture_spec.h"
#include "host/scene/aa_mode.h"
#include "host/scene/scene.h"

namespace rt {

struct PictureSize {
    int width, height;
};

/// How to render a scene, on any device. Values not given come from the scene.
struct RenderSettings {
    std::optional<PictureSize> size;
    std::optional<AaMode> aa;
    Filter filter = Filter::box;
    int seed = 0;  ///< of sobol samples
    std::optional<int> max_bounces;
    std::optional<Rect> crop;  ///< the part of the picture to render
    Precision precision = Precision::float32;
    Math math = Math::strict;
    KernelChoice kernels;
    Schedule schedule = Schedule::tiles;
    int threads = 0;  ///< 0: all cores
    std::optional<PictureSize> tile;
    std::optional<bool> hierarchies;  ///< not given: where they are faster
    bool caster_lists = true;
    bool no_fallback = false;  ///< fail when the device fails, instead of using threads
    bool self_test = true;     ///< first compare a few of a device's pixels with threads'
    /// Where finished tiles are kept, so that an interrupted render can resume; empty: nowhere.
    /// Pictures with fast math or sample buffers are not kept.
    std::string journal;
    double journal_delay = 2;      ///< seconds of tracing not worth saving
    bool fresh = false;            ///< ignore an existing journal
    std::optional<Shares> shares;  ///< render only these, into the journal, which is the result
    bool estimate = false;         ///< also estimate the picture's error
    double target_rmse = 0;        ///< the most that the estimate may be; 0: anything
    double check = 0;  ///< share of the tiles to trace again on threads and compare, 0 to 1
};

/// Sobol samples that the filter needs at least. A cubic has negative weights: a handful of
/// scattered samples may add up to nothing.
constexpr int fewest_samples(Filter filter) { return filter == Filter::mitchell ? 16 : 1; }

/// Applies the settings' overrides to the scene: size, AA, filter, seed, bounces. Throws Error
/// (ExitCode::usage) for a filter that needs more samples.
void apply_overrides(Scene& scene, const RenderSettings& settings);

/// The picture that these settings make of a scene with their overrides applied. Throws Error
/// (ExitCode::usage) for a crop that leaves the picture.
PictureSpec picture_spec(const Scene& scene, const RenderSettings& settings);

/// Settings that make such a picture of the scene.
RenderSettings settings_for(const PictureSpec& spec);

}  // namespace rt
