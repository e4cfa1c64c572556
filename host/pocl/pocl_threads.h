// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Has PoCL use so many threads, or (0) what the environment says, else one a core. One a core keep
/// to their own: woken for a picture, two often begin it on the same core, which costs
/// milliseconds. Fewer are not kept anywhere: processes with few threads each would share the first
/// cores. Nor are a process's that may not use every core. POCL_AFFINITY=0 prevents it. Without
/// effect once OpenCL has started; to be called before other threads read the environment.
void set_pocl_threads(int count);

}  // namespace rt
