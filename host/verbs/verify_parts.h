// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/journal/merge.h"

namespace rt {

/// Renders a share (0 to 1) of the picture again on threads of this machine, at least one of its
/// thousand blocks, chosen by its seed, as one more part for merge_journals to compare. `scene`:
/// the scene file; empty: the one that the header names. Returns false if a stop signal came first.
/// Throws Error: usage if the scene cannot be found.
bool render_part_again(const MergedPicture& merged, const std::string& scene, double share,
                       const std::string& part);

}  // namespace rt
