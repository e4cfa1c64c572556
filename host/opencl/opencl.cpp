// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/opencl.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/text.h"

namespace rt {

namespace {

constexpr Named<int> status_names[] = {
    {"CL_SUCCESS", 0},
    {"CL_DEVICE_NOT_FOUND", -1},
    {"CL_DEVICE_NOT_AVAILABLE", -2},
    {"CL_COMPILER_NOT_AVAILABLE", -3},
    {"CL_MEM_OBJECT_ALLOCATION_FAILURE", -4},
    {"CL_OUT_OF_RESOURCES", -5},
    {"CL_OUT_OF_HOST_MEMORY", -6},
    {"CL_IMAGE_FORMAT_MISMATCH", -9},
    {"CL_BUILD_PROGRAM_FAILURE", -11},
    {"CL_MAP_FAILURE", -12},
    {"CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST", -14},
    {"CL_INVALID_VALUE", -30},
    {"CL_INVALID_DEVICE", -33},
    {"CL_INVALID_CONTEXT", -34},
    {"CL_INVALID_COMMAND_QUEUE", -36},
    {"CL_INVALID_MEM_OBJECT", -38},
    {"CL_INVALID_BINARY", -42},
    {"CL_INVALID_BUILD_OPTIONS", -43},
    {"CL_INVALID_PROGRAM", -44},
    {"CL_INVALID_KERNEL_NAME", -46},
    {"CL_INVALID_KERNEL", -48},
    {"CL_INVALID_ARG_INDEX", -49},
    {"CL_INVALID_ARG_VALUE", -50},
    {"CL_INVALID_ARG_SIZE", -51},
    {"CL_INVALID_KERNEL_ARGS", -52},
    {"CL_INVALID_WORK_GROUP_SIZE", -54},
    {"CL_INVALID_BUFFER_SIZE", -61},
    {"CL_PLATFORM_NOT_FOUND_KHR", -1001},
};

}  // namespace

std::string cl_status_text(int status) {
    const std::string name = name_of(status_names, status);
    return fmt::format("{} ({})", name.empty() ? "OpenCL error" : name, status);
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

template <typename T>
std::vector<cl::Buffer> upload_scene(const FlatScene<T>& scene, const cl::Context& context,
                                     const cl::CommandQueue& queue, const ClDevice& device) {
    std::vector<cl::Buffer> lists;
    const auto upload = [&](const auto& items, const char* what) {
        const std::size_t bytes = items.size() * sizeof(items[0]);
        const auto& list =
            lists.emplace_back(make_cl_buffer(context, device, bytes, what, CL_MEM_READ_ONLY));
        if (bytes > 0) queue.enqueueWriteBuffer(list, CL_TRUE, 0, bytes, items.data());
    };
#define RT_UPLOAD(type, name, what) upload(scene.name, what);
    RT_SCENE_ARRAYS(RT_UPLOAD)
#undef RT_UPLOAD
    return lists;
}

template std::vector<cl::Buffer> upload_scene(const FlatScene<float>&, const cl::Context&,
                                              const cl::CommandQueue&, const ClDevice&);
template std::vector<cl::Buffer> upload_scene(const FlatScene<double>&, const cl::Context&,
                                              const cl::CommandQueue&, const ClDevice&);

cl_uint set_arguments(cl::Kernel& kernel, cl_uint first, const std::vector<cl::Buffer>& scene) {
    for (const cl::Buffer& list : scene) kernel.setArg(first++, list);
    return first;
}

}  // namespace rt
