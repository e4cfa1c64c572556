// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/opencl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/base/error.h"

namespace rt {

namespace {

struct StatusName {
    int status;
    const char* name;
};

constexpr std::array<StatusName, 28> status_names{{
    {0, "CL_SUCCESS"},
    {-1, "CL_DEVICE_NOT_FOUND"},
    {-2, "CL_DEVICE_NOT_AVAILABLE"},
    {-3, "CL_COMPILER_NOT_AVAILABLE"},
    {-4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
    {-5, "CL_OUT_OF_RESOURCES"},
    {-6, "CL_OUT_OF_HOST_MEMORY"},
    {-9, "CL_IMAGE_FORMAT_MISMATCH"},
    {-11, "CL_BUILD_PROGRAM_FAILURE"},
    {-12, "CL_MAP_FAILURE"},
    {-14, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST"},
    {-30, "CL_INVALID_VALUE"},
    {-33, "CL_INVALID_DEVICE"},
    {-34, "CL_INVALID_CONTEXT"},
    {-36, "CL_INVALID_COMMAND_QUEUE"},
    {-38, "CL_INVALID_MEM_OBJECT"},
    {-42, "CL_INVALID_BINARY"},
    {-43, "CL_INVALID_BUILD_OPTIONS"},
    {-44, "CL_INVALID_PROGRAM"},
    {-46, "CL_INVALID_KERNEL_NAME"},
    {-48, "CL_INVALID_KERNEL"},
    {-49, "CL_INVALID_ARG_INDEX"},
    {-50, "CL_INVALID_ARG_VALUE"},
    {-51, "CL_INVALID_ARG_SIZE"},
    {-52, "CL_INVALID_KERNEL_ARGS"},
    {-54, "CL_INVALID_WORK_GROUP_SIZE"},
    {-61, "CL_INVALID_BUFFER_SIZE"},
    {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
}};

}  // namespace

std::string cl_status_text(int status) {
    const auto found =
        std::find_if(status_names.begin(), status_names.end(),
                     [&](const StatusName& entry) { return entry.status == status; });
    return fmt::format("{} ({})", found == status_names.end() ? "OpenCL error" : found->name,
                       status);
}

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
