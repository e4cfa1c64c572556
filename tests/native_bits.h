// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tests/kernel_runner.h"

// What a device's probes make, held to what the native ones make.
namespace rt {

/// The bytes of each output that the native probe makes of the first `count` items in packets of
/// `lanes`. Throws as run_native_probe.
std::vector<std::vector<std::byte>> native_results(bool double_precision, int lanes,
                                                   const std::string& function, std::size_t count,
                                                   std::span<const ProbeInput> inputs,
                                                   std::span<const ProbeOutput> outputs);

/// Fails the test where native probes of any width do not make the bits of the outputs; a number's
/// NaN is like any other.
void expect_native_bits(bool double_precision, const std::string& function, std::size_t count,
                        std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs);

}  // namespace rt
