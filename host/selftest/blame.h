// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/opencl/cl_device.h"

namespace rt {

struct Blame {
    std::string verdict;     ///< what is to blame; empty: nothing is wrong
    std::string text;        ///< what was tried, and what came out
    std::string reproducer;  ///< folder with a program that shows it; empty: none
};

/// Finds out what a device computes wrongly: a function, else what whole kernels have in common
/// that render a wrong picture. Writes a reproducer to the folder. Throws Error.
Blame blame_device(const ClDevice& device, const std::string& folder);

}  // namespace rt
