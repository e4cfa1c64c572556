// SPDX-License-Identifier: Apache-2.0
#pragma once

// The OpenCL C++ bindings with the settings all of mirrorball uses. Only the cl_* files of this
// folder (and the kernel tests) include this.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <string>

namespace rt {

/// The name of an OpenCL status, such as "CL_OUT_OF_RESOURCES (-5)".
std::string cl_status_text(int status);

}  // namespace rt
