// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/mpi/ranks.h"
#include "host/options/render_options.h"

namespace rt {

/// Every other rank: renders the shares that rank 0 hands out, until rank 0 says stop.
/// Failures are reported to rank 0. Returns the exit status.
int serve_rank_0(const RenderOptions& options, Ranks& ranks);

}  // namespace rt
