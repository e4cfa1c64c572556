// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/render_options.h"

namespace rt {

/// Renders a picture on all ranks that mpirun started, each of which calls this. Rank 0 hands out
/// shares of it, renders some itself, and merges them: parts in OUTPUT.parts, a folder that all
/// ranks see. Ranks that fail, stop or are lost cost time, not the picture; rank 0 must survive.
/// Returns the exit status; throws Error.
int render_mpi(const RenderOptions& options);

}  // namespace rt
