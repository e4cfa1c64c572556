// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/opencl.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/pocl.h"

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

namespace {

/// Empty where the driver has none.
std::string build_log(const cl::Program& program, const ClDevice& device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(handle_of(device));
    } catch (const cl::Error&) {
        return "";
    }
}

/// HASH.cl, .options, .log and .bin in the folder of build_extras.
void save_build(const cl::Program& program, const ClDevice& device, const std::string& flags) {
    const std::filesystem::path folder = build_extras().folder;
    const auto source = program.getInfo<CL_PROGRAM_SOURCE>();
    Hasher hasher;
    for (const std::string& part : {device.name, source, flags}) hasher.add(part);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const auto save = [&](const char* extension, const std::string& text) {
        const std::filesystem::path file = folder / (hash_text(hasher.value()) + extension);
        if (std::ofstream(file, std::ios::binary).write(text.data(), std::ssize(text)).flush()) {
            return;
        }
        throw Error(ExitCode::output, file.string() + ": cannot be written");
    };
    save(".cl", source);
    save(".options", flags + "\n");
    save(".log", build_log(program, device));
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();  // empty where it did not build
    for (const auto& binary : binaries) save(".bin", {binary.begin(), binary.end()});
}

/// The status of clBuildProgram: cl::Program::build hides it where there is no log.
cl_int build(const cl::Program& program, const ClDevice& device, const std::string& flags) {
    const cl_int status =
        clBuildProgram(program(), 1, &device.handle, flags.c_str(), nullptr, nullptr);
    if (!build_extras().folder.empty()) save_build(program, device, flags);
    return status;
}

/// The program as PoCL builds it fastest; empty if it cannot, and on all other devices.
std::optional<cl::Program> built_for_pocl(const cl::Context& context, const ClDevice& device,
                                          const char* source, const std::string& flags) {
    if (!device.is_cpu() || device.platform != pocl_platform) return {};
    const cl::Program program(context, std::string(source));
    if (build(program, device, flags + pocl_build_options) != CL_SUCCESS) return {};
    return program;
}

}  // namespace

BuildExtras& build_extras() {
    static BuildExtras extras;
    return extras;
}

std::string build_options(const ClDevice& device, const ProgramOptions& options) {
    std::string text = "-cl-std=CL1.2";
    if (options.lanes != 1) text += fmt::format(" -DRT_LANES={}", options.lanes);
    if (options.precision == Precision::float64) text += " -DRT_DOUBLE=1";
    if (options.math == Math::fast) {
        text += " -DRT_FAST_MATH=1 -cl-mad-enable";
    } else if (device.rounds_correctly) {
        text += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    if (!options.features.all()) {
        text += fmt::format(" -DRT_FEATURE_BITS={:#x}", options.features.to_ulong());
    }
    if (options.samples != 0) text += fmt::format(" -DRT_SAMPLES={}", options.samples);
    if (!options.entries.pixels) text += " -DRT_RENDERS_PIXELS=0";
    if (!options.entries.samples) text += " -DRT_RENDERS_SAMPLES=0";
    if (!options.entries.adaptive && options.samples == 0) text += " -DRT_RENDERS_ADAPTIVE=0";
    if (!options.entries.edges && options.features[feature::edges]) text += " -DRT_RENDERS_EDGES=0";
    if (!options.entries.rays) text += " -DRT_TRACES_RAYS=0";
    for (const std::string& more : {build_extras().options, options.more}) {
        if (!more.empty()) text += " " + more;
    }
    return text;
}

cl::Program build_program(const cl::Context& context, const ClDevice& device, const char* source,
                          const ProgramOptions& options) {
    const std::string flags = build_options(device, options);
    if (auto built = built_for_pocl(context, device, source, flags)) return *built;
    const cl::Program program(context, std::string(source));
    const cl_int status = build(program, device, flags);
    if (status != CL_SUCCESS) {
        const std::string advice =
            device.platform == pocl_platform ? pocl_build_advice() : "update the driver";
        throw Error(
            ExitCode::device,
            fmt::format("the kernels do not build on {} (driver {}): {}; {} or use --device "
                        "threads\noptions: {}\n{}",
                        device.name, device.driver, cl_status_text(status), advice, flags,
                        build_log(program, device)));
    }
    return program;
}

std::shared_ptr<OpenDevices> make_open_devices() { return std::make_shared<OpenDevices>(); }

std::size_t fitting_group(const cl::Kernel& kernel, const ClDevice& device, std::size_t wanted) {
    return std::min(wanted, kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(handle_of(device)));
}

cl::Context OpenDevices::context(const ClDevice& device) {
    const std::lock_guard lock(mutex_);
    cl::Context& context = contexts_[device.handle];
    if (context() == nullptr) context = cl::Context(handle_of(device));
    return context;
}

cl::Program OpenDevices::program(const ClDevice& device, const char* source,
                                 const ProgramOptions& options) {
    const cl::Context of = context(device);
    std::unique_lock lock(mutex_);
    cl::Program& program = programs_[{device.handle, source, build_options(device, options)}];
    if (program() != nullptr) return program;
    lock.unlock();  // compiling may take long, or for ever
    const cl::Program built = build_program(of, device, source, options);
    lock.lock();
    return program = built;
}

void throw_device_error(const ClDevice& device, const cl::Error& error) {
    throw Error(ExitCode::device, fmt::format("{} failed in {}: {}", device.name, error.what(),
                                              cl_status_text(error.err())));
}

}  // namespace rt
