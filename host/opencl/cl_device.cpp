// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_device.h"

#include <fmt/format.h>

#include <utility>

#include "host/base/text.h"
#include "host/opencl/opencl.h"

namespace rt {

namespace {

/// Device strings may have padding and a trailing zero, and are not to be trusted.
std::string trimmed(const std::string& text) {
    const char* blanks = " \t\n\r";
    const std::string whole(text.c_str());
    const auto first = whole.find_first_not_of(blanks);
    if (first == std::string::npos) return "";
    return printable(whole.substr(first, whole.find_last_not_of(blanks) - first + 1));
}

/// "OpenCL 1.1 ..." and older cannot run the kernels.
bool is_too_old(const std::string& version) {
    return version.rfind("OpenCL 1.0", 0) == 0 || version.rfind("OpenCL 1.1", 0) == 0;
}

std::string why_unusable(const cl::Device& device, const std::string& version) {
    if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "its driver reports it as unavailable";
    if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "its driver has no compiler";
    if (is_too_old(version)) return version + "; OpenCL 1.2 is required";
    return "";
}

void describe_arithmetic(const cl::Device& device, ClDevice& described) {
    const auto single = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    described.rounds_correctly = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    described.keeps_subnormals = (single & CL_FP_DENORM) != 0;
    described.has_double =
        device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    described.float_lanes = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    described.double_lanes =
        described.has_double ? device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>() : 0;
}

ClDevice describe(const cl::Device& device) {
    ClDevice described;
    described.handle = device();
    described.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    described.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    described.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    described.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
    described.kind = (type & CL_DEVICE_TYPE_GPU) != 0   ? "GPU"
                     : (type & CL_DEVICE_TYPE_CPU) != 0 ? "CPU"
                                                        : "accelerator";
    described.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    described.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    described.max_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    describe_arithmetic(device, described);
    described.unusable = why_unusable(device, described.version);
    return described;
}

/// PoCL hides its device when it cannot write its kernel cache.
std::string why_no_device(const std::string& platform) {
    return fmt::format("OpenCL platform '{}' has no devices; {}", platform,
                       platform == pocl_platform
                           ? "check that its kernel cache can be written (POCL_CACHE_DIR, else "
                             "~/.cache/mirrorball), and check POCL_DEVICES"
                           : "check its driver");
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
    std::vector<cl::Device> devices;
    platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    return devices;
}

void list_platform(const cl::Platform& platform, int platform_index, ClDeviceList& list) {
    const std::string name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    try {
        const std::vector<cl::Device> devices = devices_of(platform);
        if (devices.empty()) list.problems.push_back(why_no_device(name));
        int device_index = 0;
        for (const cl::Device& device : devices) {
            ClDevice described = describe(device);
            described.platform = name;
            described.index = static_cast<int>(list.devices.size());
            described.platform_index = platform_index;
            described.device_index = device_index++;
            list.devices.push_back(std::move(described));
        }
    } catch (const cl::Error& error) {
        list.problems.push_back(
            fmt::format("OpenCL platform '{}' cannot list its devices: {}; check its driver", name,
                        cl_status_text(error.err())));
        if (list.failure.empty()) list.failure = list.problems.back();
    }
}

}  // namespace

ClDeviceList list_cl_devices() {
    ClDeviceList list;
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        const std::string text = fmt::format(
            "no OpenCL platform: {}; install pocl-opencl-icd or a GPU "
            "driver with OpenCL",
            cl_status_text(error.err()));
        if (error.err() != CL_PLATFORM_NOT_FOUND_KHR) list.failure = text;
        list.problems.push_back(text);
    }
    for (std::size_t i = 0; i < platforms.size(); ++i) {
        list_platform(platforms[i], static_cast<int>(i), list);
    }
    return list;
}

}  // namespace rt
