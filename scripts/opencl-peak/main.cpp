// SPDX-License-Identifier: Apache-2.0
//
// The peak multiply-add rate of an OpenCL device: prints {"float": FLOP/s, "double": FLOP/s or null}.
// Every work item keeps many vectors of sums in flight; an fma counts as two. Best of five launches.
//
// usage: opencl-peak DEVICE_NAME
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

constexpr const char* source = R"(
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
__kernel void peak(__global REAL *out, REAL factor, REAL addend, int rounds) {
    REALS s[SUMS];
#pragma unroll
    for (int i = 0; i < SUMS; ++i) s[i] = (REALS)((REAL)(i + (int)get_global_id(0)));
    for (int round = 0; round < rounds; ++round) {
#pragma unroll
        for (int i = 0; i < SUMS; ++i) s[i] = fma(s[i], (REALS)factor, (REALS)addend);
    }
    REALS sum = s[0];
#pragma unroll
    for (int i = 1; i < SUMS; ++i) sum += s[i];
    out[get_global_id(0)] = LAST(sum);
}
)";

void check(cl_int status, const char* what) {
    if (status == CL_SUCCESS) return;
    std::fprintf(stderr, "opencl-peak: %s: error %d\n", what, status);
    std::exit(1);
}

std::string name_of(cl_device_id device) {
    char name[512] = "";
    clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof(name) - 1, name, nullptr);
    return name;
}

cl_device_id device_named(const std::string& name) {
    cl_platform_id platforms[32];
    cl_uint platform_count = 0;
    check(clGetPlatformIDs(32, platforms, &platform_count), "platforms");
    for (cl_uint p = 0; p < std::min(platform_count, 32u); ++p) {
        cl_device_id devices[32];
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 32, devices, &count) != CL_SUCCESS) {
            continue;
        }
        for (cl_uint i = 0; i < std::min(count, 32u); ++i) {
            if (name_of(devices[i]) == name) return devices[i];
        }
    }
    std::fprintf(stderr, "opencl-peak: no device is called '%s'\n", name.c_str());
    std::exit(1);
}

template <typename Real>
double peak(cl_device_id device, const char* type) {
    cl_device_type kind = 0;
    check(clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof(kind), &kind, nullptr), "type");
    const bool is_cpu = (kind & CL_DEVICE_TYPE_CPU) != 0;
    const int width = is_cpu ? 64 / static_cast<int>(sizeof(Real)) : 1, sums = 16;
    const std::size_t items = is_cpu ? 4096 : std::size_t{1} << 20;
    const cl_int rounds = is_cpu ? 4096 : 1024;
    cl_int status = 0;
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, &status);
    check(status, "context");
    const cl_command_queue queue =
        clCreateCommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE, &status);
    check(status, "queue");
    const char* text = source;
    const cl_program program = clCreateProgramWithSource(context, 1, &text, nullptr, &status);
    check(status, "program");
    const std::string vector = std::string(type) + (width > 1 ? std::to_string(width) : "");
    const std::string options = std::string("-DREAL=") + type + " -DREALS=" + vector +
                                " -DSUMS=" + std::to_string(sums) +
                                (width > 1 ? " -DLAST(v)=(v).s0" : " -DLAST(v)=(v)");
    check(clBuildProgram(program, 1, &device, options.c_str(), nullptr, nullptr), "build");
    const cl_kernel kernel = clCreateKernel(program, "peak", &status);
    check(status, "kernel");
    const cl_mem out =
        clCreateBuffer(context, CL_MEM_WRITE_ONLY, items * sizeof(Real), nullptr, &status);
    check(status, "buffer");
    const Real factor = Real(0.999), addend = Real(0.001);
    check(clSetKernelArg(kernel, 0, sizeof(out), &out), "argument");
    check(clSetKernelArg(kernel, 1, sizeof(factor), &factor), "argument");
    check(clSetKernelArg(kernel, 2, sizeof(addend), &addend), "argument");
    check(clSetKernelArg(kernel, 3, sizeof(rounds), &rounds), "argument");
    double best = 0;
    for (int attempt = 0; attempt < 6; ++attempt) {
        const std::size_t group = is_cpu ? 1 : 64;
        cl_event event = nullptr;
        check(clEnqueueNDRangeKernel(queue, kernel, 1, nullptr, &items, &group, 0, nullptr, &event),
              "launch");
        check(clWaitForEvents(1, &event), "wait");
        cl_ulong start = 0, end = 0;
        clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof(start), &start, nullptr);
        clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof(end), &end, nullptr);
        clReleaseEvent(event);
        const double flop =
            2.0 * width * sums * static_cast<double>(rounds) * static_cast<double>(items);
        if (attempt > 0 && end > start) {
            best = std::max(best, flop / (static_cast<double>(end - start) * 1e-9));
        }
    }
    clReleaseMemObject(out);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    return best;
}

bool has_double(cl_device_id device) {
    cl_device_fp_config config = 0;
    return clGetDeviceInfo(device, CL_DEVICE_DOUBLE_FP_CONFIG, sizeof(config), &config, nullptr) ==
               CL_SUCCESS &&
           config != 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: opencl-peak DEVICE_NAME\n");
        return 2;
    }
    const cl_device_id device = device_named(argv[1]);
    std::printf("{\"float\": %g, ", peak<float>(device, "float"));
    if (has_double(device)) {
        std::printf("\"double\": %g}\n", peak<double>(device, "double"));
    } else {
        std::printf("\"double\": null}\n");
    }
    return 0;
}
