// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Sets the variables that PoCL reads. Without effect once OpenCL has started; to be called before
/// other threads read the environment.
///
/// Threads: `count`, or (0) what the environment says, else one a core. One a core keep to their
/// own: woken for a picture, two often begin it on the same core, which costs milliseconds. Fewer
/// are not kept anywhere: processes with few threads each would share the first cores. Nor are a
/// process's that may not use every core. POCL_AFFINITY=0 prevents it.
///
/// Kernel cache: POCL_CACHE_DIR, unless it is empty, another user's, or open to all to write; then
/// and by default mirrorball/pocl in $XDG_CACHE_HOME or ~/.cache, closed to others. PoCL runs what
/// lies there.
///
/// PATH: with /usr/bin where it has no `ld`, which PoCL calls, and without which it ends the
/// process.
void prepare_pocl(int count);

}  // namespace rt
