// SPDX-License-Identifier: Apache-2.0
//
// An OpenCL driver that goes wrong: a library to put between the program and the loader
// (LD_PRELOAD).
//   CL_SHIM_OLD, CL_SHIM_NEW   program texts have NEW in place of OLD, which they must contain
//   CL_SHIM_FROM               from this program on, counted from 1; from the first unless given
//   CL_SHIM_LOG                a file that gets the options of each build, a line each
//   CL_SHIM_FAIL_LAUNCH        the kernel launch that fails, and all after it, counted from 1
//   CL_SHIM_FAIL_READ          if not empty, nothing can be read or mapped once a launch failed
// Nothing in mirrorball knows of it.
#include <dlfcn.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
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

}  // namespace

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

bool fails_to_read() { return has_failed() && !setting("CL_SHIM_FAIL_READ").empty(); }

}  // namespace

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel,
                                         cl_uint dimensions, const std::size_t* offset,
                                         const std::size_t* size, const std::size_t* local,
                                         cl_uint count, const cl_event* waits, cl_event* event) {
    ++launches;
    if (has_failed()) return CL_OUT_OF_RESOURCES;
    return real<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel")(
        queue, kernel, dimensions, offset, size, local, count, waits, event);
}

extern "C" void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool is_blocking,
                                    cl_map_flags flags, std::size_t offset, std::size_t size,
                                    cl_uint count, const cl_event* waits, cl_event* event,
                                    cl_int* error) {
    if (fails_to_read()) {
        *error = CL_OUT_OF_HOST_MEMORY;
        return nullptr;
    }
    return real<decltype(clEnqueueMapBuffer)>("clEnqueueMapBuffer")(
        queue, buffer, is_blocking, flags, offset, size, count, waits, event, error);
}

extern "C" cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                                 const char* options, void(CL_CALLBACK* done)(cl_program, void*),
                                 void* user_data) {
    if (const std::string log = setting("CL_SHIM_LOG"); !log.empty()) {
        std::ofstream(log, std::ios::app) << (options == nullptr ? "" : options) << '\n';
    }
    return real<decltype(clBuildProgram)>("clBuildProgram")(program, count, devices, options, done,
                                                            user_data);
}
