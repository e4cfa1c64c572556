// SPDX-License-Identifier: Apache-2.0
#include "tests/kernel_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "host/base/error.h"
#include "host/opencl/device_spec.h"
#include "host/opencl/pocl.h"
#include "host/selftest/probes.h"
#include "tests/native_bits.h"

namespace rt {

namespace {

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
        return usable(device) && device.platform == pocl_platform;
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
    const ClDeviceList list = list_cl_devices();
    const std::string spec = asked_device();
    if (spec.empty()) return default_device(list.devices);
    const DeviceChoice choice = choose_device(spec, list);
    if (choice.use_threads) {
        throw Error(ExitCode::usage,
                    fmt::format("MIRRORBALL_TEST_DEVICE={}: not an OpenCL device", spec));
    }
    return choice.device;
}

/// What scripts/record-probes asks for: the file to write, or nothing.
std::string recorded_file() {
    const char* file = std::getenv("MIRRORBALL_RECORD_PROBES");
    return file == nullptr ? "" : file;
}

/// Collects the launches of strict probes, the first items of each, for `mirrorball selftest`.
class Recorder {
   public:
    void add(bool is_double, const std::string& function, std::size_t all,
             std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
        const bool has_scene = inputs.size() >= scene_inputs;
        const std::size_t most = has_scene ? 24 : 64;
        const auto count = function == "layout" ? all : std::min(all, most);
        auto& [items, records] = launches_[{has_scene, function, is_double}];
        ProbeRecord record{function, is_double, static_cast<std::uint32_t>(count), {}, {}};
        std::size_t bytes = 0;
        for (const ProbeInput& input : inputs) {
            record.inputs.push_back(cut(input, count, all));
            bytes += record.inputs.back().bytes.size();
        }
        if (items + count > 3 * most || bytes > most_bytes) return;
        for (const ProbeOutput& output : outputs) {
            const auto* begin = static_cast<const std::byte*>(output.data);
            record.outputs.push_back({{begin, begin + count * output.item_bytes},
                                      static_cast<std::uint32_t>(output.item_bytes),
                                      output.holds_numbers});
        }
        items += count;
        check(record, outputs);
        records.push_back(std::move(record));
    }

    void save(const std::string& file) {
        std::vector<ProbeRecord> all;
        for (auto& [function, launches] : launches_) {
            all.insert(all.end(), launches.second.begin(), launches.second.end());
        }
        std::ofstream(file, std::ios::binary) << encoded(all);
    }

   private:
    static constexpr std::size_t most_bytes = 20000;

    /// The input for the first `count` of `all` items. A list of another length than theirs is the
    /// same for all items.
    static ProbeArray cut(const ProbeInput& input, std::size_t count, std::size_t all) {
        const auto* begin = static_cast<const std::byte*>(input.data);
        const bool is_shared = input.item_bytes == 0 || input.bytes != all * input.item_bytes;
        return {{begin, begin + (is_shared ? input.bytes : count * input.item_bytes)},
                is_shared ? 0 : static_cast<std::uint32_t>(input.item_bytes)};
    }

    /// Whether these inputs give these results.
    static void check(const ProbeRecord& record, std::span<const ProbeOutput> outputs) {
        std::vector<ProbeInput> inputs;
        for (const ProbeArray& input : record.inputs) {
            inputs.push_back({input.bytes.data(), input.bytes.size(), input.item_bytes});
        }
        expect_native_bits(record.is_double, record.function, record.count, inputs, outputs);
    }

    /// Items and launches of each function and precision, those that take scenes last.
    std::map<std::tuple<bool, std::string, bool>, std::pair<std::size_t, std::vector<ProbeRecord>>>
        launches_;
};

Recorder recorder;

/// Opens the device on first use and releases it after the last test, while the OpenCL library is
/// still intact: static destructors would be too late.
class ProbeEnvironment : public testing::Environment {
   public:
    ProbeDevice& open() {
        if (!device_) device_ = std::make_unique<ProbeDevice>(test_device());
        return *device_;
    }
    void TearDown() override {
        device_.reset();
        if (!recorded_file().empty()) recorder.save(recorded_file());
    }

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
        ProgramOptions build;
        build.precision = double_precision ? Precision::float64 : Precision::float32;
        build.math = fast_math ? Math::fast : Math::strict;
        build.warnings_are_errors = probes.device().platform == pocl_platform;
        probes.launch(build, function, count, inputs, outputs);
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
    if (fast_math) return;
    if (!recorded_file().empty()) {
        recorder.add(double_precision, function, count, inputs, outputs);
    } else {
        expect_native_bits(double_precision, function, count, inputs, outputs);
    }
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
