// SPDX-License-Identifier: Apache-2.0
//
// An OpenCL driver that misbehaves: a library to load between the program and the OpenCL loader
// (LD_PRELOAD).
//   CL_SHIM_OLD, CL_SHIM_NEW   NEW replaces OLD in program texts, which must contain it
//   CL_SHIM_FROM               the first program to change, counted from 1; 1 if not given
//   CL_SHIM_LOG                a file for the options of each build, one line each
//   CL_SHIM_FAIL_LAUNCH        the kernel launch that fails, and all after it, counted from 1
//   CL_SHIM_INEXACT            if not empty, devices do not promise to round correctly
//   CL_SHIM_GPU                if not empty, devices are GPUs, with groups of 32 items at most
//   CL_SHIM_NO_CHILD           if not empty, no child process can be started
//   CL_SHIM_DIE_IN             the function whose call fails
//   CL_SHIM_DIE_BY             how: abort, segfault, exit, hang, spin, error, or delay (2 s); for
//                              clGetEventInfo, by error means that an event stays submitted
//   CL_SHIM_DIE_AT             the first call that may fail, counted from 1
//   CL_SHIM_DIE_AFTER          seconds that a call takes before it fails
//   CL_SHIM_DIE_WITH           .icd files, separated by blanks, all of which must be in use
//   CL_SHIM_FOLDERS            if not empty, OCL_ICD_VENDORS must be a folder, as for Khronos'
//   loader
// Nothing in mirrorball knows about it.
#include <dlfcn.h>
#include <spawn.h>
#include <unistd.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_ext.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace {

template <typename Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::string setting(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

bool goes_wrong_now() {
    static std::atomic<int> programs = 0;
    const std::string first = setting("CL_SHIM_FROM");
    return ++programs >= (first.empty() ? 1 : std::stoi(first)) && !setting("CL_SHIM_OLD").empty();
}

void replace(std::string& text) {
    const std::string old = setting("CL_SHIM_OLD");
    const std::size_t at = text.find(old);
    if (at == std::string::npos) {
        std::fprintf(stderr, "cl_shim: no program contains: %s\n", old.c_str());
        std::_Exit(99);
    }
    text.replace(at, old.size(), setting("CL_SHIM_NEW"));
}

/// Whether the loader uses all these .icd files.
bool uses_drivers(const std::string& names) {
    namespace fs = std::filesystem;
    const std::string place = setting("OCL_ICD_VENDORS");
    std::set<std::string> used;
    const auto use = [&](const fs::path& file) { used.insert(fs::canonical(file).filename()); };
    if (fs::is_directory(place)) {
        for (const auto& entry : fs::directory_iterator(place)) use(entry.path());
    } else {
        use(place);
    }
    std::istringstream list(names);
    for (std::string name; list >> name;) {
        if (used.count(name) == 0) return false;
    }
    return true;
}

/// Called at the start of each function below; whether it returns an error.
bool die_in(const char* function) {
    if (setting("CL_SHIM_DIE_IN") != function) return false;
    const std::string with = setting("CL_SHIM_DIE_WITH");
    if (!with.empty() && !uses_drivers(with)) return false;
    static std::atomic<int> calls = 0;
    const std::string at = setting("CL_SHIM_DIE_AT");
    if (++calls < (at.empty() ? 1 : std::stoi(at))) return false;
    if (const std::string after = setting("CL_SHIM_DIE_AFTER"); !after.empty()) {
        sleep(std::stoi(after));
    }
    const std::string by = setting("CL_SHIM_DIE_BY");
    if (by == "abort") std::abort();
    if (by == "exit") std::exit(1);
    if (by == "segfault") *static_cast<volatile int*>(nullptr) = 0;
    while (by == "hang") pause();
    while (by == "spin") {  // a third of the time, for the sake of other tests
        const auto begun = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(10)) {
        }
        usleep(20'000);
    }
    if (by == "delay") sleep(2);
    return by == "error" || by == "none";
}

}  // namespace

extern "C" int posix_spawn(pid_t* process, const char* path,
                           const posix_spawn_file_actions_t* actions,
                           const posix_spawnattr_t* attributes, char* const* arguments,
                           char* const* variables) {
    if (!setting("CL_SHIM_NO_CHILD").empty()) return EAGAIN;
    return real<decltype(posix_spawn)>("posix_spawn")(process, path, actions, attributes, arguments,
                                                      variables);
}

extern "C" cl_int clGetPlatformIDs(cl_uint size, cl_platform_id* platforms, cl_uint* count) {
    const bool is_folder = std::filesystem::is_directory(setting("OCL_ICD_VENDORS"));
    if (!setting("CL_SHIM_FOLDERS").empty() && !is_folder) return CL_PLATFORM_NOT_FOUND_KHR;
    if (die_in("clGetPlatformIDs")) return CL_OUT_OF_HOST_MEMORY;
    return real<decltype(clGetPlatformIDs)>("clGetPlatformIDs")(size, platforms, count);
}

extern "C" cl_int clGetDeviceIDs(cl_platform_id platform, cl_device_type type, cl_uint size,
                                 cl_device_id* devices, cl_uint* count) {
    if (die_in("clGetDeviceIDs")) {
        return setting("CL_SHIM_DIE_BY") == "none" ? CL_DEVICE_NOT_FOUND : CL_OUT_OF_HOST_MEMORY;
    }
    return real<decltype(clGetDeviceIDs)>("clGetDeviceIDs")(platform, type, size, devices, count);
}

extern "C" cl_int clGetDeviceInfo(cl_device_id device, cl_device_info name, std::size_t size,
                                  void* value, std::size_t* needed) {
    const cl_int error =
        real<decltype(clGetDeviceInfo)>("clGetDeviceInfo")(device, name, size, value, needed);
    if (name == CL_DEVICE_SINGLE_FP_CONFIG && value != nullptr &&
        !setting("CL_SHIM_INEXACT").empty()) {
        *static_cast<cl_device_fp_config*>(value) &= ~CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    }
    if (name == CL_DEVICE_TYPE && value != nullptr && !setting("CL_SHIM_GPU").empty()) {
        *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_GPU;
    }
    return error;
}

extern "C" cl_int clGetEventInfo(cl_event event, cl_event_info name, std::size_t size, void* value,
                                 std::size_t* needed) {
    const cl_int error =
        real<decltype(clGetEventInfo)>("clGetEventInfo")(event, name, size, value, needed);
    if (name == CL_EVENT_COMMAND_EXECUTION_STATUS && die_in("clGetEventInfo")) {
        *static_cast<cl_int*>(value) = CL_SUBMITTED;
    }
    return error;
}

extern "C" cl_context clCreateContext(const cl_context_properties* properties, cl_uint count,
                                      const cl_device_id* devices,
                                      void(CL_CALLBACK* notify)(const char*, const void*,
                                                                std::size_t, void*),
                                      void* data, cl_int* error) {
    if (die_in("clCreateContext")) {
        *error = CL_OUT_OF_HOST_MEMORY;
        return nullptr;
    }
    return real<decltype(clCreateContext)>("clCreateContext")(properties, count, devices, notify,
                                                              data, error);
}

extern "C" cl_int clFinish(cl_command_queue queue) {
    if (die_in("clFinish")) return CL_OUT_OF_HOST_MEMORY;
    return real<decltype(clFinish)>("clFinish")(queue);
}

extern "C" cl_program clCreateProgramWithSource(cl_context context, cl_uint count,
                                                const char** strings, const std::size_t* lengths,
                                                cl_int* error) {
    std::string text;
    for (cl_uint i = 0; i < count; ++i) {
        const bool has_length = lengths != nullptr && lengths[i] != 0;
        text += has_length ? std::string(strings[i], lengths[i]) : std::string(strings[i]);
    }
    if (goes_wrong_now()) replace(text);
    const char* one = text.c_str();
    return real<decltype(clCreateProgramWithSource)>("clCreateProgramWithSource")(context, 1, &one,
                                                                                  nullptr, error);
}

namespace {

std::atomic<int> launches = 0;

bool has_failed() {
    const std::string first = setting("CL_SHIM_FAIL_LAUNCH");
    return !first.empty() && launches >= std::stoi(first);
}

std::size_t most_in_group() { return setting("CL_SHIM_GPU").empty() ? 4096 : 32; }

}  // namespace

extern "C" cl_int clGetKernelWorkGroupInfo(cl_kernel kernel, cl_device_id device,
                                           cl_kernel_work_group_info name, std::size_t size,
                                           void* value, std::size_t* needed) {
    const cl_int error = real<decltype(clGetKernelWorkGroupInfo)>("clGetKernelWorkGroupInfo")(
        kernel, device, name, size, value, needed);
    if (name == CL_KERNEL_WORK_GROUP_SIZE && value != nullptr) {
        auto& most = *static_cast<std::size_t*>(value);
        most = std::min(most, most_in_group());
    }
    return error;
}

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel,
                                         cl_uint dimensions, const std::size_t* offset,
                                         const std::size_t* size, const std::size_t* local,
                                         cl_uint count, const cl_event* waits, cl_event* event) {
    if (die_in("clEnqueueNDRangeKernel")) return CL_OUT_OF_HOST_MEMORY;
    ++launches;
    if (has_failed()) return CL_OUT_OF_RESOURCES;
    if (local != nullptr && *local > most_in_group()) return CL_INVALID_WORK_GROUP_SIZE;
    return real<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel")(
        queue, kernel, dimensions, offset, size, local, count, waits, event);
}

extern "C" cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                                 const char* options, void(CL_CALLBACK* done)(cl_program, void*),
                                 void* user_data) {
    if (die_in("clBuildProgram")) return CL_OUT_OF_HOST_MEMORY;
    if (const std::string log = setting("CL_SHIM_LOG"); !log.empty()) {
        std::ofstream(log, std::ios::app) << (options == nullptr ? "" : options) << '\n';
    }
    return real<decltype(clBuildProgram)>("clBuildProgram")(program, count, devices, options, done,
                                                            user_data);
}
