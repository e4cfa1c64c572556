// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/cli/batch_list.h"
#include "host/cli/options.h"
#include "host/cli/render_options.h"
#include "host/image/output_path.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

void settle_journal(RenderOptions& render) {
    if (render.fresh && render.resume) usage_error("--fresh cannot be combined with --resume");
    if (render.resume) render.journal_delay = 0;
    if (!render.shares) return;
    if (render.is_batch()) usage_error("--shard works only for a single scene");
    if (!render.reference.empty() || render.expected_hash) {
        usage_error("--reference and --expect cannot be combined with --shard");
    }
    if (render.math == Math::fast || render.schedule != Schedule::tiles) {
        usage_error("--shard requires --math strict and --schedule tiles, so that its parts match");
    }
    if (!render.output.ends_with(".mbj")) usage_error("--shard requires -o FILE.mbj");
}

/// What a target starts with. The error of edges:T is about T.
AaMode first_aa(double target_rmse, Filter filter) {
    if (filter == Filter::box) {
        const double tolerance = std::clamp(target_rmse, AaMode::min_tolerance, 1.0);
        return {AaMode::Pattern::edges, 1, tolerance};
    }
    return {AaMode::Pattern::sobol, std::max(fewest_samples(filter), 4), 0};
}

/// A target starts with a few samples; its journal would be of another picture each time.
void settle_estimate(RenderOptions& render) {
    if (render.target_rmse > 0) {
        if (render.shares || render.resume) {
            usage_error("--target-rmse cannot be combined with --shard or --resume");
        }
        if (!render.aa) render.aa = first_aa(render.target_rmse, render.filter);
        if (render.aa->refines()) {
            usage_error("--target-rmse requires --aa edges:T, sobol:N or grid:N");
        }
    }
    if (render.estimate && render.shares) {
        usage_error("--estimate works only for a whole picture, without --shard");
    }
}

/// Threads have no fast math, so every tile would differ.
void settle_check(const RenderOptions& render) {
    if (render.check > 0 && render.math == Math::fast)
        usage_error("--check requires --math strict");
}

void settle_watch(const RenderOptions& render) {
    if (!render.watch) return;
    if (render.is_batch() || render.scene == stdin_scene || render.shares) {
        usage_error("--watch works only for a single scene file, without --shard");
    }
    if (render.output == stdout_path || render.timeout > 0) {
        usage_error("--watch cannot be combined with -o - or --timeout");
    }
}

/// Rejects two uses of the same standard stream.
void settle_streams(RenderOptions& render) {
    settle_picture_output(render.output, render.format);
    const bool prints = render.stats != StatsFormat::summary || !render.reference.empty();
    if (render.output == stdout_path && prints) {
        usage_error("-o - cannot be combined with --stats or --reference, which print to stdout");
    }
    if (render.batch == "-" &&
        std::ranges::find(render.scenes, stdin_scene) != render.scenes.end()) {
        usage_error("standard input cannot be both a scene and a list of scenes");
    }
}

/// Frames of one scene; with shares, every nth frame.
void settle_frames(RenderOptions& render) {
    if (render.scenes.size() != 1 || !render.batch.empty()) {
        usage_error("--frames requires exactly one scene");
    }
    if (!render.reference.empty() || render.expected_hash) {
        usage_error("--reference and --expect cannot be combined with --frames");
    }
    render.output = batch_output(render.output, render.scenes.front());
    const bool is_pattern =
        render.frames.size() > 1 || render.output.find('%') != std::string::npos;
    if (!render.output.empty() && is_pattern && !find_frame_number(render.output)) {
        usage_error("-o '{}': with --frames, use %04d for the frame number, as in out.%04d.png",
                    render.output);
    }
    if (!render.shares) return;
    std::vector<int> own;
    for (std::size_t i = 0; i < render.frames.size(); ++i) {
        const int share = static_cast<int>(i % static_cast<std::size_t>(render.shares->of));
        if (std::ranges::find(render.shares->numbers, share) != render.shares->numbers.end()) {
            own.push_back(render.frames[i]);
        }
    }
    if (own.empty()) usage_error("--shard leaves no frames to render; use fewer shares");
    render.frames = std::move(own);
    render.shares.reset();
}

/// One scene, or a batch.
void settle_scenes(RenderOptions& render) {
    if (!render.frames.empty()) return settle_frames(render);
    if (!render.is_batch()) {
        if (render.scenes.empty()) {
            usage_error("SCENE is required; see 'mirrorball render --help'");
        }
        render.scene = render.scenes.front();
        if (find_frame_number(render.output)) {
            usage_error("-o '{}' contains a frame number; add --frames or change the name",
                        render.output);
        }
        render.output = batch_output(render.output, render.scene);
        return;
    }
    if (!render.reference.empty() || render.expected_hash) {
        usage_error("--reference and --expect work only for a single scene");
    }
    if (!render.output.empty() && render.output.find("%s") == std::string::npos) {
        usage_error("-o '{}': with several scenes, use %s for the scene's name, as in out/%s.png",
                    render.output);
    }
}

void settle_aovs(const RenderOptions& render) {
    if (render.aovs.empty()) return;
    if (render.is_batch() || render.shares) {
        usage_error("--aov works only for a single, whole picture");
    }
    if (render.output.empty() || render.output == stdout_path) {
        usage_error("--aov requires -o FILE, from which it derives its file names");
    }
}

}  // namespace

void settle_render(RenderOptions& render) {
    settle_streams(render);
    settle_scenes(render);
    settle_journal(render);
    settle_estimate(render);
    settle_check(render);
    settle_watch(render);
    settle_aovs(render);
}

}  // namespace rt
