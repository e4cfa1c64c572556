// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"

namespace rt {

/// Programs that this process has compiled, kept as binaries for CPU drivers without a cache: a
/// report or the stress suite asks for the same kernels many times, and Intel's runtime takes a
/// minute for some. PoCL and most GPU drivers have caches on disk.
///
/// A program built from the binary of an earlier one with this source and options; empty if there
/// is none, or if the driver no longer accepts it.
std::optional<cl::Program> kept_program(const cl::Context& context, const ClDevice& device,
                                        const char* source, const std::string& options);

/// Keeps a built program, unless the device's driver does so.
void keep_program(const cl::Program& program, const ClDevice& device, const char* source,
                  const std::string& options);

}  // namespace rt
