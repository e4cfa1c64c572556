// SPDX-License-Identifier: Apache-2.0
#include "host/pocl/pocl_threads.h"

#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include <string>

namespace rt {

namespace {

constexpr const char* most_threads = "POCL_MAX_PTHREAD_COUNT";
constexpr const char* least_threads = "POCL_PTHREAD_MIN_THREADS";

/// The number of cores, where this process may use them all; else 0.
int cores_to_use() {
    cpu_set_t usable;
    if (sched_getaffinity(0, sizeof(usable), &usable) != 0) return 0;
    const auto cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    for (int core = 0; core < cores; ++core) {
        if (!CPU_ISSET(static_cast<std::size_t>(core), &usable)) return 0;
    }
    return cores;
}

}  // namespace

void set_pocl_threads(int count) {
    constexpr int overwrite = 1;
    const int cores = cores_to_use();
    if (count == 0 && !getenv(most_threads) && !getenv(least_threads)) count = cores;
    if (count == 0) return;
    setenv(most_threads, std::to_string(count).c_str(), overwrite);
    // PoCL puts thread i on core i, and ends the process where there is no such core.
    if (count == cores && !getenv(least_threads)) setenv("POCL_AFFINITY", "1", !overwrite);
}

}  // namespace rt
