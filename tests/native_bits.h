// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tests/kernel_runner.h"

// Compares the results of a device's probes with those of the native ones.
namespace rt {

/// The bytes of each output of the native probe for the first `count` items, in packets of `lanes`.
/// Throws as run_native_probe.
std::vector<std::vector<std::byte>> native_results(bool double_precision, int lanes,
                                                   const std::string& function, std::size_t count,
                                                   std::span<const ProbeInput> inputs,
                                                   std::span<const ProbeOutput> outputs);

/// Fails the test unless native probes of every width give the same bits; all NaNs are equal.
void expect_native_bits(bool double_precision, const std::string& function, std::size_t count,
                        std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs);

}  // namespace rt
