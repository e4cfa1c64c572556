// SPDX-License-Identifier: Apache-2.0
#include "host/render/launch_pacer.h"

#include <algorithm>

namespace rt {

LaunchPacer::LaunchPacer(std::int64_t first, std::int64_t most)
    : samples_(std::clamp<std::int64_t>(first, 1, most)), most_(most) {}

void LaunchPacer::note(std::int64_t samples, double seconds) {
    // Written so that a clock that does not advance means most_growth.
    const double growth = target_seconds < seconds * most_growth ? target_seconds / seconds
                                                                 : static_cast<double>(most_growth);
    const double wanted = static_cast<double>(samples) * growth;
    samples_ = static_cast<std::int64_t>(std::clamp(wanted, 1.0, static_cast<double>(most_)));
}

}  // namespace rt
