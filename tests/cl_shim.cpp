// SPDX-License-Identifier: Apache-2.0
//
// An OpenCL driver that goes wrong: a library to put between the program and the loader
// (LD_PRELOAD).
//   CL_SHIM_OLD, CL_SHIM_NEW   program texts have NEW in place of OLD, which they must contain
//   CL_SHIM_FROM               from this program on, counted from 1; from the first unless given
//   CL_SHIM_LOG                a file that gets the options of each build, a line each
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

extern "C" cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                                 const char* options, void(CL_CALLBACK* done)(cl_program, void*),
                                 void* user_data) {
    if (const std::string log = setting("CL_SHIM_LOG"); !log.empty()) {
        std::ofstream(log, std::ios::app) << (options == nullptr ? "" : options) << '\n';
    }
    return real<decltype(clBuildProgram)>("clBuildProgram")(program, count, devices, options, done,
                                                            user_data);
}
