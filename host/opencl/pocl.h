// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

// What PoCL needs that other drivers do not.
namespace rt {

inline constexpr const char* pocl_platform = "Portable Computing Language";

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
/// to others; else, or where PoCL has no room for its name, a temporary folder of this process.
/// PoCL runs the code it finds there.
///
/// PATH: without relative folders, and with /usr/bin and /bin if it has no `ld`, which PoCL calls,
/// ending the process if it is missing.
void prepare_pocl(int count);

/// Has PoCL begin with an empty kernel cache, in the temporary folder: the first build of each
/// kernel is then cold and all others are warm, whatever ran before. Call it before prepare_pocl.
void start_fresh_pocl_cache();

/// Removes the temporary folder, or what PoCL leaves in the permanent one, when OpenCL is no longer
/// needed.
void leave_pocl_cache();

/// Where PoCL keeps kernels, once prepare_pocl has been called.
std::filesystem::path pocl_cache_folder();

/// Whether it keeps them at all: POCL_KERNEL_CACHE=0 is for its developers.
bool pocl_keeps_kernels();

/// Why PoCL cannot write its kernel cache: "FOLDER: Permission denied"; empty where it can.
std::string why_pocl_cache_is_read_only();

/// With these options PoCL builds the kernels in a fraction of the time; they fail to build where a
/// kernel calls what kernels/builtins.h does not declare.
///
/// PoCL reads 18,000 lines of declarations at every build, even a cached one, and spends most of
/// its time on that. The first option tells its compiler that they were read (by the guard of
/// Clang's opencl-c.h), and the second the kernels to declare what they call.
///
/// PoCL optimizes and compiles three copies of each kernel: its own, and two that loop over work
/// groups. The third option leaves only a call in them (kernels/render.cl), in 0.75 of the time.
inline constexpr const char* pocl_build_options =
    " -D_OPENCL_H_ -DRT_DECLARES_BUILTINS=1 -DRT_ITEM=__attribute__((noinline))";

/// Advice for when PoCL fails to build.
std::string pocl_build_advice();

}  // namespace rt
