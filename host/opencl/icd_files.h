// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// A line for each .icd file whose driver cannot be loaded, which OpenCL passes over in silence.
/// `place` is such a file, or a folder of them. Each driver is loaded in a child process: some
/// crash or hang. Call it before OpenCL or any thread has started.
std::vector<std::string> broken_icd_files(const std::string& place);

}  // namespace rt
