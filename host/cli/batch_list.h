// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/cli/render_options.h"

namespace rt {

/// Whether the name of an output has one "%d" or "%04d", to be replaced by a frame's number, unless
/// a letter or digit follows.
bool has_frame_number(const std::string& name);

/// The pattern with each %s, unless a letter or digit follows, replaced by the scene's name,
/// without folder and extension.
std::string batch_output(const std::string& pattern, const std::string& scene);

/// The pictures of a batch: the frames, or the scenes of the command line and then those of the
/// list, a line each: "SCENE" or "SCENE OUTPUT", with names with blanks in double quotes; empty
/// lines and those that begin with '#' are none. Throws Error: ExitCode::input for a list that
/// cannot be read, ExitCode::usage for a wrong line, and if two pictures would share a file.
std::vector<BatchItem> batch_items(const RenderOptions& options);

}  // namespace rt
