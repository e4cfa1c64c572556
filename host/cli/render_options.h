// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/cli/command_line.h"
#include "host/image/encoding.h"
#include "host/image/picture_io.h"
#include "host/picture/render_settings.h"
#include "host/scene/scene_file.h"
#include "host/view/viewer.h"

namespace rt {

/// Of an animation.
inline constexpr int last_frame = 999999;

/// Per-pixel data that render --aov saves in addition to the color.
enum class Aov { depth, normal, id, rays, samples };

inline constexpr Named<Aov> aov_names[] = {{"depth", Aov::depth},
                                           {"normal", Aov::normal},
                                           {"id", Aov::id},
                                           {"rays", Aov::rays},
                                           {"samples", Aov::samples}};

inline const char* to_string(Aov aov) { return name_of(aov_names, aov); }

enum class StatsFormat { summary, text, json };
enum class ProgressMode { automatic, bar, plain, json, none };

/// A picture to be rendered.
struct BatchItem {
    std::string where;  ///< "list.txt:3: ", for messages; empty: the command line
    std::string scene;
    std::string output;  ///< empty: none
    std::optional<int> frame;
};

/// `mirrorball render`; defaults are the scene's.
struct RenderOptions : RenderSettings {
    std::string scene;
    LightOverrides light;
    std::string output;  ///< empty: none; "-": stdout; with several scenes %s is the name
    std::optional<PictureFormat> format;  ///< of stdout; files go by their extension
    std::vector<std::string> scenes;      ///< all of them, if there are several
    std::string batch;                    ///< a file that names scenes, "-": stdin; empty: none
    std::vector<int> frames;              ///< of the scene's camera path; empty: the scene as it is
    std::vector<BatchItem> items;         ///< the pictures that these name
    std::string device;                   ///< comma-separated list; empty: the best available
    std::string reference;                ///< empty: none
    std::optional<std::uint64_t> expected_hash;  ///< of the picture
    Encoding encoding = Encoding::display;
    StatsFormat stats = StatsFormat::summary;
    ProgressMode progress = ProgressMode::automatic;
    bool resume = false;         ///< requested explicitly
    std::vector<Aov> aovs;       ///< to be saved next to the picture
    ViewSettings view;           ///< where to show the picture while it renders
    bool watch = false;          ///< render again when the scene's files change
    double timeout = 0;          ///< seconds until it gives up; 0: never
    bool isolate = true;         ///< OpenCL in a separate process
    double deadline = 10;        ///< seconds without progress after which a driver is hung
    std::string failed_device;   ///< that threads replace
    std::string device_failure;  ///< how it failed
    /// What a worker told of the pictures of a batch before its driver failed; see print_finished.
    std::vector<std::string> batch_past;
    bool quiet = false, verbose = false;

    bool is_batch() const { return !batch.empty() || scenes.size() > 1 || !frames.empty(); }
};

/// Checks the options of `render` against one another once all are read, and derives the others.
/// Throws Error (ExitCode::usage) for options that cannot be combined.
void settle_render(RenderOptions& render);

/// `mirrorball render`. Returns the exit status.
int run_render(const RenderOptions& options, const Invocation& call);

}  // namespace rt
