// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

// The probes compiled ahead of time as pthreads' kernels are (tests/native_probes.cl), one shared
// object for each precision and width of a packet.
namespace rt {

inline constexpr int native_probe_lanes[] = {1, 2, 4, 8, 16};

/// Runs probe_FUNCTION over `count` items in packets of `lanes`, on this thread; `arrays` are the
/// inputs, then the outputs. Throws Error (ExitCode::device) where there is no such probe, and
/// where this processor cannot run them.
void run_native_probe(bool double_precision, int lanes, const std::string& function,
                      std::uint32_t count, std::span<void* const> arrays);

}  // namespace rt
