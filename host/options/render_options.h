// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/flatten/features.h"
#include "host/image/encoding.h"
#include "host/render/cl_renderer.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_queue.h"
#include "host/scene/aa_mode.h"
#include "host/scene/scene_file.h"

namespace rt {

enum class Precision { float32, float64 };
enum class StatsFormat { summary, text, json };
enum class ProgressMode { automatic, bar, plain, json, none };

struct PictureSize {
    int width, height;
};

/// `mirrorball render`; what is not given is the scene's.
struct RenderOptions {
    std::string scene;
    std::string output;  ///< empty: render, write nothing
    std::string device;  ///< empty: the best there is
    std::optional<PictureSize> size;
    std::optional<AaMode> aa;
    Filter filter = Filter::box;
    int sampling_seed = 0;  ///< of sobol samples
    std::optional<int> max_bounces;
    LightOverrides light;
    Precision precision = Precision::float32;
    bool fast_math = false;
    Launch launch = Launch::automatic;
    int lanes = 0;    ///< rays of a packet; 0: as suits the device
    std::string isa;  ///< instruction set of the threads' kernels; empty: the best
    Schedule schedule = Schedule::tiles;
    int threads = 0;  ///< 0: all cores
    bool all_features = false;
    Features also_features = no_features();  ///< compiled, needed or not
    bool any_samples = false;                ///< compile the loop over them, needed or not
    std::optional<bool> hierarchies;         ///< not given: where they are faster
    bool caster_lists = true;
    std::optional<Rect> crop;
    std::optional<PictureSize> tile;
    std::string reference;  ///< empty: none
    Encoding encoding = Encoding::display;
    StatsFormat stats = StatsFormat::summary;
    ProgressMode progress = ProgressMode::automatic;
    bool no_fallback = false;  ///< fail when the device fails, instead of using threads
    bool quiet = false, verbose = false;
    bool dumb_terminal = false;  ///< TERM=dumb: no bar
};

}  // namespace rt
