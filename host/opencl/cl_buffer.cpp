// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_buffer.h"

#include <fmt/format.h>

#include "host/base/error.h"

namespace rt {

cl::Buffer make_cl_buffer(const cl::Context& context, const ClDevice& device, std::size_t bytes,
                          const char* what, cl_mem_flags flags, void* host) {
    if (bytes == 0) return {};
    if (bytes > device.max_buffer_bytes) {
        throw Error(ExitCode::limit,
                    fmt::format("{} needs a buffer of {} bytes, but {} allows at most {}; use "
                                "--crop to render it in parts, or --device threads",
                                what, bytes, device.name, device.max_buffer_bytes));
    }
    return cl::Buffer(context, flags, bytes, host);
}

}  // namespace rt
