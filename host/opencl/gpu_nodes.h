// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// Whether the kernel shows a GPU or another accelerator among its device files, so that OpenCL is
/// worth loading to find it: NVIDIA's, direct rendering's, AMD's compute, WSL's, accelerators'.
bool gpu_may_be_here(const std::string& folder = "/dev");

}  // namespace rt
