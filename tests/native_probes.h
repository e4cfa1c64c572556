// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

// The probes, compiled ahead of time like the pthreads kernels (tests/native_probes.cl), as one
// shared object per precision and packet width.
namespace rt {

inline constexpr int native_probe_lanes[] = {1, 4, 16};

/// Runs probe_FUNCTION over `count` items in packets of `lanes`, on this thread; `arrays` are the
/// inputs, then the outputs. Throws Error (ExitCode::device) if there is no such probe, or if this
/// processor cannot run it.
void run_native_probe(bool double_precision, int lanes, const std::string& function,
                      std::uint32_t count, std::span<void* const> arrays);

}  // namespace rt
