// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

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
