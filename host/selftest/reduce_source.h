// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// OpenCL C without comments and without the functions that the kernel does not reach. What macros
/// mention counts as called: they paste names together.
std::string reduced_to_kernel(const std::string& source, const std::string& kernel);

}  // namespace rt
