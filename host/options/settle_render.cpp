// SPDX-License-Identifier: Apache-2.0
#include "host/options/settle_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "host/error.h"
#include "host/image/output_path.h"
#include "host/options/aov.h"
#include "host/options/frame_number.h"
#include "host/options/picture_output.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

void check_renders_parts(const RenderOptions& render, const char* option) {
    if (!render.fast_math && render.schedule == Schedule::tiles) return;
    throw Error(ExitCode::usage, fmt::format("{} needs --math strict and --schedule tiles: the "
                                             "parts must be bit-identical to the whole picture",
                                             option));
}

void settle_journal(RenderOptions& render) {
    if (render.fresh && render.resume) {
        throw Error(ExitCode::usage, "--fresh and --resume exclude each other");
    }
    if (render.resume) render.journal_delay = 0;
    if (!render.shares) return;
    if (render.is_batch()) throw Error(ExitCode::usage, "--shard takes one scene");
    if (!render.reference.empty()) {
        throw Error(ExitCode::usage, "--reference needs a whole picture; leave out --shard");
    }
    check_renders_parts(render, "--shard");
    if (!render.output.ends_with(".mbj")) {
        throw Error(ExitCode::usage, "--shard writes a part of a picture: give -o FILE.mbj");
    }
}

/// Threads have no fast math, so every tile would differ.
void settle_check(const RenderOptions& render) {
    if (render.check > 0 && render.fast_math) {
        throw Error(ExitCode::usage, "--check compares bits: it needs --math strict");
    }
}

void settle_watch(const RenderOptions& render) {
    if (!render.watch) return;
    if (render.is_batch() || render.scene == stdin_scene || render.shares) {
        throw Error(ExitCode::usage, "--watch is for one scene file");
    }
    if (render.output == stdout_path || render.timeout > 0) {
        throw Error(ExitCode::usage, "--watch goes on until Ctrl-C: not with -o - or --timeout");
    }
}

/// A worker of an MPI rank has the rank's command, but renders one share.
void settle_rank_share(RenderOptions& render) {
    const std::size_t colon = render.rank_share.find(':');
    if (colon == std::string::npos) return;
    render.shares = parse_shares(render.rank_share.substr(0, colon));
    render.output = render.rank_share.substr(colon + 1);
    render.mpi = false;
    render.quiet = true;
}

/// --mpi merges the picture from parts, which have no figures and cannot be viewed.
void settle_mpi(const RenderOptions& render) {
    if (!render.mpi) return;
    if (render.is_batch() || render.scene == stdin_scene || render.shares || render.watch) {
        throw Error(ExitCode::usage, "--mpi renders one scene file, once");
    }
    if (render.output.empty() || render.output == stdout_path) {
        throw Error(ExitCode::usage, "--mpi writes a file: give -o FILE");
    }
    if (render.stats != StatsFormat::summary || !render.reference.empty() || !render.aovs.empty() ||
        render.view.any()) {
        throw Error(ExitCode::usage,
                    "--mpi writes the picture alone: not with --stats, --reference, --aov, --show, "
                    "--preview or --tev");
    }
    check_renders_parts(render, "--mpi");
}

/// Rejects two uses of the same standard stream.
void settle_streams(RenderOptions& render) {
    settle_picture_output(render.output, render.format);
    const bool prints = render.stats != StatsFormat::summary || !render.reference.empty();
    if (render.output == stdout_path && prints) {
        throw Error(
            ExitCode::usage,
            "-o - uses standard output, which --stats and --reference also need; write to a file");
    }
    const auto& scenes = render.scenes;
    if (render.batch == "-" &&
        std::find(scenes.begin(), scenes.end(), stdin_scene) != scenes.end()) {
        throw Error(ExitCode::usage, "standard input is a scene or a list of scenes, not both");
    }
}

/// Frames of one scene; with shares, every nth frame.
void settle_frames(RenderOptions& render) {
    if (render.scenes.size() != 1 || !render.batch.empty()) {
        throw Error(ExitCode::usage, "--frames takes one scene");
    }
    if (!render.reference.empty()) {
        throw Error(ExitCode::usage, "--reference is for one picture; leave out --frames");
    }
    render.output = batch_output(render.output, render.scenes.front());
    const bool is_pattern =
        render.frames.size() > 1 || render.output.find('%') != std::string::npos;
    if (!render.output.empty() && is_pattern && !find_frame_number(render.output)) {
        throw Error(ExitCode::usage, fmt::format("-o '{}' names one file for several frames; use "
                                                 "%04d for the frame number, as in out.%04d.png",
                                                 render.output));
    }
    if (!render.shares) return;
    std::vector<int> own;
    for (std::size_t i = 0; i < render.frames.size(); ++i) {
        const auto& numbers = render.shares->numbers;
        const int share = static_cast<int>(i % static_cast<std::size_t>(render.shares->of));
        if (std::find(numbers.begin(), numbers.end(), share) != numbers.end()) {
            own.push_back(render.frames[i]);
        }
    }
    if (own.empty())
        throw Error(ExitCode::usage, "--shard gives this share no frames; use fewer shares");
    render.frames = std::move(own);
    render.shares.reset();
}

/// One scene, or a batch.
void settle_scenes(RenderOptions& render) {
    if (!render.frames.empty()) return settle_frames(render);
    if (!render.is_batch()) {
        if (render.scenes.empty()) {
            throw Error(ExitCode::usage, "SCENE is required; see 'mirrorball render --help'");
        }
        render.scene = render.scenes.front();
        if (find_frame_number(render.output)) {
            throw Error(ExitCode::usage,
                        fmt::format("-o '{}' has a frame number; give --frames, or another name",
                                    render.output));
        }
        render.output = batch_output(render.output, render.scene);
        return;
    }
    if (!render.reference.empty()) {
        throw Error(ExitCode::usage, "--reference takes one scene");
    }
    if (!render.output.empty() && render.output.find("%s") == std::string::npos) {
        throw Error(ExitCode::usage, fmt::format("-o '{}' names one file for several scenes; use "
                                                 "%s for the scene's name, as in out/%s.png",
                                                 render.output));
    }
}

}  // namespace

void settle_render(RenderOptions& render) {
    settle_rank_share(render);
    settle_streams(render);
    settle_scenes(render);
    settle_journal(render);
    settle_check(render);
    settle_watch(render);
    settle_mpi(render);
    settle_aovs(render);
}

}  // namespace rt
