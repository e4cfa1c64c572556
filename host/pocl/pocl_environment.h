// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Sets the variables that PoCL reads. Has no effect once OpenCL has started; call it before other
/// threads read the environment.
///
/// Threads: `count`, or (0) what the environment says, else one per core. One per core are pinned:
/// when woken for a picture, two often start on the same core, which costs milliseconds. Fewer are
/// not pinned: processes with few threads each would share the first cores. Nor are those of a
/// process that may not use every core. POCL_AFFINITY=0 prevents pinning.
///
/// Kernel cache: POCL_CACHE_DIR, unless it is empty, another user's, or world-writable; else
/// mirrorball/pocl in $XDG_CACHE_HOME or ~/.cache, without a home in $TMPDIR/mirrorball-UID, closed
/// to others; else a temporary folder of this process. PoCL runs the code it finds there.
///
/// PATH: adds /usr/bin and /bin if it has no `ld`, which PoCL calls, ending the process if it is
/// missing.
void prepare_pocl(int count);

/// Removes the temporary folder, if there is one, when OpenCL is no longer needed.
void remove_private_pocl_cache();

}  // namespace rt
