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

/// Options that cannot be combined, and what to say then.
struct Conflict {
    bool is_there;
    const char* message;
};

void refuse_conflicts(const std::vector<Conflict>& conflicts) {
    for (const Conflict& conflict : conflicts) {
        if (conflict.is_there) usage_error("{}", conflict.message);
    }
}

/// What a target starts with. The error of edges:T is about T.
AaMode first_aa(double target_rmse, Filter filter) {
    if (filter == Filter::box) {
        const double tolerance = std::clamp(target_rmse, AaMode::min_tolerance, 1.0);
        return {AaMode::Pattern::edges, 1, tolerance};
    }
    return {AaMode::Pattern::sobol, std::max(fewest_samples(filter), 4), 0};
}

bool compares(const RenderOptions& render) {
    return !render.reference.empty() || render.expected_hash;
}

/// Rejects two uses of the same standard stream.
void settle_streams(RenderOptions& render) {
    settle_picture_output(render.output, render.format);
    const bool prints = render.stats != StatsFormat::summary || !render.reference.empty();
    const bool reads_scene = std::ranges::count(render.scenes, stdin_scene) > 0;
    refuse_conflicts(
        {{render.output == stdout_path && prints,
          "-o - cannot be combined with --stats or --reference, which print to stdout"},
         {render.batch == "-" && reads_scene,
          "standard input cannot be both a scene and a list of scenes"}});
}

/// Frames of one scene; with shares, every nth frame.
void settle_frames(RenderOptions& render) {
    refuse_conflicts(
        {{render.scenes.size() != 1 || !render.batch.empty(),
          "--frames requires exactly one scene"},
         {compares(render), "--reference and --expect cannot be combined with --frames"}});
    render.output = batch_output(render.output, render.scenes.front());
    const bool is_pattern =
        render.frames.size() > 1 || render.output.find('%') != std::string::npos;
    if (!render.output.empty() && is_pattern && !has_frame_number(render.output)) {
        usage_error("-o '{}': with --frames, use %04d for the frame number, as in out.%04d.png",
                    render.output);
    }
    if (!render.shares) return;
    std::vector<int> own;
    for (std::size_t i = 0; i < render.frames.size(); ++i) {
        const int share = static_cast<int>(i % static_cast<std::size_t>(render.shares->of));
        if (std::ranges::count(render.shares->numbers, share) > 0) own.push_back(render.frames[i]);
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
        if (has_frame_number(render.output)) {
            usage_error("-o '{}' contains a frame number; add --frames or change the name",
                        render.output);
        }
        render.output = batch_output(render.output, render.scene);
        return;
    }
    if (compares(render)) usage_error("--reference and --expect work only for a single scene");
    if (!render.output.empty() && render.output.find("%s") == std::string::npos) {
        usage_error("-o '{}': with several scenes, use %s for the scene's name, as in out/%s.png",
                    render.output);
    }
}

}  // namespace

void settle_render(RenderOptions& render) {
    settle_streams(render);
    settle_scenes(render);
    const bool has_shares = render.shares.has_value(), is_batch = render.is_batch();
    const bool has_target = render.target_rmse > 0, is_fast = render.math == Math::fast;
    if (render.resume) render.journal_delay = 0;
    if (has_target && !render.aa) render.aa = first_aa(render.target_rmse, render.filter);
    refuse_conflicts(
        {{render.fresh && render.resume, "--fresh cannot be combined with --resume"},
         {has_shares && is_batch, "--shard works only for a single scene"},
         {has_shares && compares(render),
          "--reference and --expect cannot be combined with --shard"},
         {has_shares && (is_fast || render.schedule != Schedule::tiles),
          "--shard requires --math strict and --schedule tiles, so that its parts match"},
         {has_shares && !render.output.ends_with(".mbj"), "--shard requires -o FILE.mbj"},
         // A target starts with a few samples; its journal would be of another picture each time.
         {has_target && (has_shares || render.resume),
          "--target-rmse cannot be combined with --shard or --resume"},
         {has_target && render.aa->refines(),
          "--target-rmse requires --aa edges:T, sobol:N or grid:N"},
         {render.estimate && has_shares,
          "--estimate works only for a whole picture, without --shard"},
         // Threads have no fast math, so every tile would differ.
         {render.check > 0 && is_fast, "--check requires --math strict"},
         {render.watch && (is_batch || render.scene == stdin_scene || has_shares),
          "--watch works only for a single scene file, without --shard"},
         {render.watch && (render.output == stdout_path || render.timeout > 0),
          "--watch cannot be combined with -o - or --timeout"},
         {!render.aovs.empty() && (is_batch || has_shares),
          "--aov works only for a single, whole picture"},
         {!render.aovs.empty() && (render.output.empty() || render.output == stdout_path),
          "--aov requires -o FILE, from which it derives its file names"}});
    if (is_batch) render.items = batch_items(render);
}

}  // namespace rt
