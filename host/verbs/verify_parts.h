// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/journal/journal_format.h"

namespace rt {

/// Renders a share (0 to 1) of the picture on threads of this machine, as one more part of it for
/// merge_journals to compare: at least one of its thousand blocks. `scene`: where to find the
/// scene; empty: where the header says. Returns whether it was finished; not when a stop signal
/// came. Throws Error: usage where the scene cannot be found.
bool render_part_again(const JournalHeader& header, const std::string& scene, double share,
                       const std::string& part);

}  // namespace rt
