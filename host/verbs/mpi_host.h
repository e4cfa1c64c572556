// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/mpi/ranks.h"
#include "host/options/render_options.h"

namespace rt {

/// Rank 0: hands out the shares of a picture, renders some on a separate thread, and
/// merges them. Returns the exit status; the caller still has to end the other ranks. Throws
/// Error.
int host_ranks(const RenderOptions& options, Ranks& ranks);

}  // namespace rt
