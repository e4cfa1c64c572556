// SPDX-License-Identifier: Apache-2.0
#include "host/render/pocl_threads.h"

#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include <string>

namespace rt {

namespace {

constexpr const char* count_variable = "POCL_MAX_PTHREAD_COUNT";

/// PoCL has a thread for each core that is there, and gives thread i core i.
bool may_use_every_core() {
    cpu_set_t cores;
    if (sched_getaffinity(0, sizeof(cores), &cores) != 0) return false;
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    for (long core = 0; core < count; ++core) {
        if (!CPU_ISSET(static_cast<std::size_t>(core), &cores)) return false;
    }
    return true;
}

}  // namespace

void set_pocl_threads(int most) {
    constexpr int overwrite = 1;
    if (most > 0) {
        setenv(count_variable, std::to_string(most).c_str(), overwrite);
    } else if (!getenv(count_variable) && may_use_every_core()) {
        setenv("POCL_AFFINITY", "1", !overwrite);
    }
}

}  // namespace rt
