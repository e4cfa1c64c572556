// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

namespace rt {

/// Seconds that all threads of the program together have computed. What else runs on the machine
/// disturbs them less than those of the clock.
inline double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace rt
