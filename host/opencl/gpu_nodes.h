// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// Whether the folder shows device files of a GPU or another accelerator, so that OpenCL is worth
/// loading to find it: NVIDIA, AMD compute, WSL, Mali, PowerVR, DRI render or accel nodes.
bool gpu_may_be_here(const std::string& folder = "/dev");

}  // namespace rt
