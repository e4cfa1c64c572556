// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Sets how many threads PoCL uses at most (0: as many as there are cores) and, where it uses all
/// cores, keeps each thread on its own: woken for a picture, two often begin it on the same core,
/// which costs milliseconds. What the environment says about cores (POCL_AFFINITY,
/// POCL_MAX_PTHREAD_COUNT) goes first, and a process that may not use every core is left alone.
/// Without effect once OpenCL has started; to be called before other threads read the environment.
void set_pocl_threads(int most);

}  // namespace rt
