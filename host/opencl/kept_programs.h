// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"

namespace rt {

/// What this process has compiled, as binaries, for CPU drivers that keep none themselves: a report
/// or the stress suite asks for the same kernels many times, and Intel's runtime takes a minute for
/// some. PoCL and most GPU drivers have caches on disk.
///
/// A program built from the binary of an earlier one from this source with these options; nothing
/// where there is none, or where the driver no longer takes it.
std::optional<cl::Program> kept_program(const cl::Context& context, const ClDevice& device,
                                        const char* source, const std::string& options);

/// Keeps a program that was built, unless the device's driver does so.
void keep_program(const cl::Program& program, const ClDevice& device, const char* source,
                  const std::string& options);

}  // namespace rt
