// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

namespace rt {

/// Processor time of all threads of the program together, in seconds. Other load on the machine
/// affects it less than wall-clock time.
inline double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace rt
