// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/flatten/features.h"
#include "host/picture/render_stats.h"
#include "host/record/record.h"

namespace rt {

/// "spheres, glass", the switches that are on (used) or off; "nothing" when there are none.
std::string names_text(const Features& features, bool used);

/// "4 spheres, ..., 128 triangles".
std::string kinds_text(const FlattenStats& stats);

/// "4 spheres, ..., 128 triangles, 2 lights, mirrors, glass": what the scene holds.
std::string holdings_text(const SceneStats& scene);

/// What flatten built: "BVH: triangles (1059607 nodes, 23 deep), built in 0.330 s", and how many
/// light-triangle pairs cast shadows. A line each.
std::string flatten_text(const FlattenStats& stats);

/// One line: what was rendered where, how fast, and the picture's hash.
std::string summary_line(const RenderStats& stats);

/// One line: every figure of an image error.
std::string error_line(const ImageError& error);

/// The table of `compare`: one line per figure of an image error between pictures with that many
/// pixels. If no pixel was finite in both, it says so instead.
std::string error_table(const ImageError& error, std::size_t pixels);

/// The table of --stats: phases as in the paper (set-up, ray trace, resolve and write, total), rays
/// by kind, and what the scene needed and did not need.
std::string stats_text(const RenderStats& stats);

/// The processor's name, with family and model on x86, where one name is given to many: "Intel(R)
/// Xeon(R) Processor (family 6, model 143)"; "unknown" where the system does not report it.
std::string cpu_name();

/// The machine and program behind a result: program, git revision, compiler, CPU, cores, memory,
/// operating system, kernel, load.
Json environment_json();

/// One rendering in format "mirrorball-render", version 1 (docs/results-format.md).
Json stats_json(const RenderStats& stats);

}  // namespace rt
