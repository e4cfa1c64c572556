// SPDX-License-Identifier: Apache-2.0
#include "tests/kernel_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

#include "host/base/error.h"
#include "host/opencl/cl_program.h"
#include "host/opencl/device_spec.h"
#include "tests/native_bits.h"

namespace rt {

/// tests/probes.cl with its includes, embedded at build time.
extern const char* const probe_kernels;

namespace {

/// One work-group size and few items per launch: PoCL recompiles a kernel for any other size, and
/// again for more than 64 K items.
constexpr std::size_t local_size = 64;
constexpr std::size_t launch_items = 65536 - local_size;

/// Set while a FastMath lives.
bool fast_math = false;

/// What MIRRORBALL_TEST_DEVICE says, or nothing.
std::string asked_device() {
    const char* spec = std::getenv("MIRRORBALL_TEST_DEVICE");
    return spec == nullptr ? "" : spec;
}

/// Whether to run without OpenCL, with the native probes only.
bool is_native_alone() { return asked_device() == "none"; }

ClDevice default_device(const std::vector<ClDevice>& devices) {
    const auto usable = [](const ClDevice& device) { return device.unusable.empty(); };
    auto found = std::find_if(devices.begin(), devices.end(), [&](const ClDevice& device) {
        return usable(device) && device.platform == "Portable Computing Language";
    });
    if (found == devices.end()) found = std::find_if(devices.begin(), devices.end(), usable);
    if (found == devices.end()) {
        throw Error(ExitCode::device,
                    "the kernel tests need an OpenCL device; install "
                    "pocl-opencl-icd");
    }
    return *found;
}

ClDevice test_device() {
    std::vector<std::string> problems;
    const auto devices = list_cl_devices(problems);
    const std::string spec = asked_device();
    if (spec.empty()) return default_device(devices);
    const DeviceChoice choice = choose_device(spec, devices, problems);
    if (choice.use_threads) {
        throw Error(ExitCode::usage,
                    fmt::format("MIRRORBALL_TEST_DEVICE={}: not an OpenCL device", spec));
    }
    return choice.device;
}

/// A device with its queue and the probes in both precisions and both arithmetics, each built on
/// first use.
class ProbeDevice {
   public:
    ProbeDevice() : device_(test_device()), context_(handle_of(device_)), queue_(context_) {}

    const ClDevice& device() const { return device_; }

    void launch(bool double_precision, const std::string& function, std::size_t count,
                std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
        cl::Kernel kernel(program(double_precision), ("probe_" + function).c_str());
        check_arguments(kernel, 2 + inputs.size() + outputs.size());
        const std::vector<cl::Buffer> buffers = bind(kernel, inputs, outputs);
        kernel.setArg(1, static_cast<cl_uint>(count));
        for (std::size_t first = 0; first < count; first += launch_items) {
            kernel.setArg(0, static_cast<cl_uint>(first));
            const std::size_t items = std::min(count - first, launch_items);
            const std::size_t rounded = (items + local_size - 1) / local_size * local_size;
            queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(rounded),
                                        cl::NDRange(local_size));
        }
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const cl::Buffer& buffer = buffers[inputs.size() + i];
            queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, outputs[i].bytes(), outputs[i].data);
        }
    }

   private:
    const cl::Program& program(bool double_precision) {
        auto& program = programs_[(double_precision ? 1 : 0) + (fast_math ? 2 : 0)];
        if (!program) {
            ProgramOptions options;
            options.precision = double_precision ? Precision::float64 : Precision::float32;
            options.math = fast_math ? Math::fast : Math::strict;
            options.warnings_are_errors = true;
            program = build_program(context_, device_, probe_kernels, options);
        }
        return *program;
    }

    static void check_arguments(const cl::Kernel& kernel, std::size_t given) {
        const auto wanted = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
        if (wanted != given) {
            throw Error(ExitCode::usage,
                        fmt::format("the probe takes {} arguments (first, count, ...) and was "
                                    "given {}",
                                    wanted, given));
        }
    }

    /// Makes the buffers, inputs first, and binds them from argument 2 on. An empty array becomes
    /// one unused byte, since OpenCL has no empty buffers.
    std::vector<cl::Buffer> bind(cl::Kernel& kernel, std::span<const ProbeInput> inputs,
                                 std::span<const ProbeOutput> outputs) {
        std::vector<cl::Buffer> buffers;
        for (const ProbeInput& input : inputs) {
            buffers.emplace_back(context_, CL_MEM_READ_ONLY, std::max<std::size_t>(input.bytes, 1));
            if (input.bytes == 0) continue;
            queue_.enqueueWriteBuffer(buffers.back(), CL_TRUE, 0, input.bytes, input.data);
        }
        for (const ProbeOutput& output : outputs) {
            buffers.emplace_back(context_, CL_MEM_READ_WRITE, output.bytes());
        }
        for (cl_uint i = 0; i < buffers.size(); ++i) kernel.setArg(2 + i, buffers[i]);
        return buffers;
    }

    ClDevice device_;
    cl::Context context_;
    cl::CommandQueue queue_;
    std::array<std::optional<cl::Program>, 4> programs_;
};

/// Opens the device on first use and releases it after the last test, while the OpenCL library is
/// still intact: static destructors would be too late.
class ProbeEnvironment : public testing::Environment {
   public:
    ProbeDevice& open() {
        if (!device_) device_ = std::make_unique<ProbeDevice>();
        return *device_;
    }
    void TearDown() override { device_.reset(); }

   private:
    std::unique_ptr<ProbeDevice> device_;
};

/// GoogleTest owns it.
ProbeEnvironment* const environment = new ProbeEnvironment;
[[maybe_unused]] const auto* const registered = testing::AddGlobalTestEnvironment(environment);

/// Runs the one-lane native probe instead of a device's.
void launch_native(bool double_precision, const std::string& function, std::size_t count,
                   std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
    const auto results = native_results(double_precision, 1, function, count, inputs, outputs);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        std::memcpy(outputs[i].data, results[i].data(), results[i].size());
    }
}

void launch_on_device(bool double_precision, const std::string& function, std::size_t count,
                      std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
    ProbeDevice& probes = environment->open();
    const auto failed = [&](const std::string& what) {
        return Error(ExitCode::device, fmt::format("probe_{} in {} on {}: {}", function,
                                                   double_precision ? "double" : "float",
                                                   probes.device().name, what));
    };
    try {
        probes.launch(double_precision, function, count, inputs, outputs);
    } catch (const cl::Error& error) {
        throw failed(fmt::format("{}: {}", error.what(), cl_status_text(error.err())));
    } catch (const Error& error) {
        throw failed(error.what());
    }
}

}  // namespace

void launch_probe(bool double_precision, const std::string& function, std::size_t count,
                  std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
    const auto launch = is_native_alone() ? launch_native : launch_on_device;
    launch(double_precision, function, count, inputs, outputs);
    if (!fast_math) expect_native_bits(double_precision, function, count, inputs, outputs);
}

FastMath::FastMath() { fast_math = true; }
FastMath::~FastMath() { fast_math = false; }

std::string test_device_name() {
    return is_native_alone() ? "pthreads" : environment->open().device().name;
}
bool test_device_has_double() {
    return is_native_alone() || environment->open().device().has_double;
}

}  // namespace rt
