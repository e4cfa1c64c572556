// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_program.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "host/error.h"
#include "host/opencl/kept_programs.h"
#include "host/opencl/opencl.h"
#include "host/pocl/pocl_cache.h"

namespace rt {

namespace {

/// PoCL reads 18,000 lines of declarations at every build, even a cached one, and spends most of
/// its time on that. This tells its compiler that they were read (by the guard of Clang's
/// opencl-c.h), and the kernels to declare what they call (kernels/builtins.h).
constexpr const char* own_declarations = " -D_OPENCL_H_ -DRT_DECLARES_BUILTINS=1";

/// PoCL optimizes and compiles three copies of each kernel: its own, and two that loop over work
/// groups. This leaves only a call in them (kernels/render.cl), in 0.75 of the time.
constexpr const char* one_copy = " -DRT_ITEM=__attribute__((noinline))";

/// The program as PoCL builds it fastest; empty if it calls what kernels/builtins.h does not
/// declare, and on all other devices.
std::optional<cl::Program> built_for_pocl(const cl::Context& context, const ClDevice& device,
                                          const char* source, const std::string& flags) {
    if (!device.is_cpu || device.platform != pocl_platform) return {};
    const cl::Program program(context, std::string(source));
    const std::string all_flags = flags + own_declarations + one_copy;
    if (clBuildProgram(program(), 1, &device.handle, all_flags.c_str(), nullptr, nullptr) !=
        CL_SUCCESS) {
        return {};
    }
    return program;
}

/// Advice after a failed build.
std::string what_to_do(const ClDevice& device) {
    const std::string cache = device.platform == pocl_platform ? why_pocl_cache_is_read_only() : "";
    if (cache.empty()) return "update the driver";
    return "PoCL cannot write its kernel cache (" + cache +
           "): set POCL_CACHE_DIR to a folder that it can write";
}

}  // namespace

std::string build_options(const ClDevice& device, const ProgramOptions& options) {
    std::string text = "-cl-std=CL1.2";
    if (options.lanes != 1) text += fmt::format(" -DRT_LANES={}", options.lanes);
    if (options.double_precision) text += " -DRT_DOUBLE=1";
    if (options.fast_math) {
        text += " -DRT_FAST_MATH=1 -cl-mad-enable";
    } else if (device.rounds_correctly) {
        text += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    if (options.warnings_are_errors) text += " -Werror";
    for (const FeatureName& feature : feature_names) {
        if (!(options.features.*feature.flag)) text += fmt::format(" -D{}=0", feature.macro);
    }
    if (options.samples != 0) text += fmt::format(" -DRT_SAMPLES={}", options.samples);
    if (!options.entries.pixels) text += " -DRT_RENDERS_PIXELS=0";
    if (!options.entries.samples) text += " -DRT_RENDERS_SAMPLES=0";
    if (!options.entries.list) text += " -DRT_RENDERS_LIST=0";
    if (!options.entries.rays) text += " -DRT_TRACES_RAYS=0";
    return text;
}

cl::Program build_program(const cl::Context& context, const ClDevice& device, const char* source,
                          const ProgramOptions& options) {
    const std::string flags = build_options(device, options);
    if (auto kept = kept_program(context, device, source, flags)) return *std::move(kept);
    if (auto built = built_for_pocl(context, device, source, flags)) return *built;
    const cl::Device handle = handle_of(device);
    cl::Program program(context, std::string(source));
    try {
        program.build({handle}, flags.c_str());
    } catch (const cl::Error& error) {
        const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(handle);
        throw Error(
            ExitCode::device,
            fmt::format("the kernels do not build on {} (driver {}): {}; {} or use --device "
                        "threads\noptions: {}\n{}",
                        device.name, device.driver, cl_status_text(error.err()), what_to_do(device),
                        flags, log));
    }
    keep_program(program, device, source, flags);
    return program;
}

void throw_device_error(const ClDevice& device, const cl::Error& error) {
    throw Error(ExitCode::device, fmt::format("{} failed in {}: {}", device.name, error.what(),
                                              cl_status_text(error.err())));
}

}  // namespace rt
