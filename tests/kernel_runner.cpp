// SPDX-License-Identifier: Apache-2.0
#include "tests/kernel_runner.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/opencl/devices.h"
#include "host/opencl/pocl.h"
#include "host/record/record.h"
#include "host/selftest/selftest.h"
#include "tests/native_probes.h"

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

/// The first items of a launch. A list of another length than theirs is the same for all items.
ProbeRecord first_items(ProbeRecord launch, std::size_t most) {
    const std::size_t all = launch.count, count = std::min(all, most);
    for (ProbeArray& input : launch.inputs) {
        const bool is_shared = input.bytes.size() != all * input.item_bytes;
        if (is_shared) input.item_bytes = 0;
        if (!is_shared) input.bytes.resize(count * input.item_bytes);
    }
    for (ProbeArray& output : launch.outputs) output.bytes.resize(count * output.item_bytes);
    launch.count = static_cast<std::uint32_t>(count);
    return launch;
}

/// Runs the native probe instead of a device's, in packets of `lanes`.
void launch_native(ProbeRecord& launch, int lanes) {
    std::vector<void*> arrays;
    for (auto* list : {&launch.inputs, &launch.outputs}) {
        for (ProbeArray& array : *list) arrays.push_back(array.bytes.data());
    }
    run_native_probe(launch.is_double, lanes, launch.function, launch.count, arrays);
}

/// Fails the test unless native probes of every width give the same bits.
void expect_native_bits(const ProbeRecord& launch) {
    for (const int lanes : native_probe_lanes) {
        ProbeRecord native = launch;
        launch_native(native, lanes);
        EXPECT_EQ(difference(launch, native), "")
            << fmt::format("probe_{} in {} with {} lanes on pthreads", launch.function,
                           precision_name(launch), lanes);
    }
}

Json json_of(const std::vector<ProbeArray>& arrays) {
    Json list = Json::array();
    for (const ProbeArray& array : arrays) {
        const auto* const begin = reinterpret_cast<const std::uint8_t*>(array.bytes.data());
        list.push_back({array.item_bytes, array.holds_numbers,
                        Json::binary({begin, begin + array.bytes.size()})});
    }
    return list;
}

/// The file that recorded_probes reads.
std::string encoded(const std::vector<ProbeRecord>& records) {
    Json list = Json::array();
    for (const ProbeRecord& record : records) {
        list.push_back({record.function, record.is_double, record.count, json_of(record.inputs),
                        json_of(record.outputs)});
    }
    const std::vector<std::uint8_t> plain = Json::to_msgpack(list);
    const uLongf plain_size = plain.size();
    uLongf size = compressBound(plain_size);
    std::vector<Bytef> packed(size);
    compress2(packed.data(), &size, plain.data(), plain_size, Z_BEST_COMPRESSION);
    return std::string(reinterpret_cast<const char*>(&plain_size), sizeof(plain_size)) +
           std::string(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
}

/// Collects launches of strict probes, the first items of each, for `mirrorball selftest`.
class Recorder {
   public:
    void add(const ProbeRecord& launch) {
        const bool has_scene = launch.has_scene();
        ProbeRecord record = first_items(launch, most_items(has_scene));
        Hasher hasher;
        std::size_t bytes = 0;
        for (const ProbeArray& input : record.inputs) {
            hasher.add_bytes(input.bytes);
            bytes += input.bytes.size();
        }
        if (bytes > most_bytes) return;
        launches_[{has_scene, launch.function, launch.is_double}].insert(
            {hasher.value(), std::move(record)});
    }

    /// Of each function some, chosen by their hashes: the compiler chooses the order of tests.
    void save(const std::string& file) {
        std::vector<ProbeRecord> all;
        for (auto& [function, launches] : launches_) {
            std::size_t items = 0;
            for (auto& [hash, record] : launches) {
                if (items + record.count > 6 * most_items(record.has_scene())) continue;
                items += record.count;
                expect_native_bits(record);
                all.push_back(std::move(record));
            }
        }
        std::ofstream(file, std::ios::binary) << encoded(all);
    }

   private:
    static constexpr std::size_t most_bytes = 20000;
    static constexpr std::size_t most_items(bool has_scene) { return has_scene ? 12 : 32; }

    /// Launches of each function and precision by a hash of their inputs, those that take scenes
    /// last.
    std::map<std::tuple<bool, std::string, bool>, std::map<std::uint64_t, ProbeRecord>> launches_;
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
ProbeEnvironment* const probe_environment = new ProbeEnvironment;
[[maybe_unused]] const auto* const registered =
    testing::AddGlobalTestEnvironment(probe_environment);

void launch_on_device(ProbeRecord& launch) {
    ProbeDevice& probes = probe_environment->open();
    const auto failed = [&](const std::string& what) {
        return Error(ExitCode::device,
                     fmt::format("probe_{} in {} on {}: {}", launch.function,
                                 precision_name(launch), probes.device().name, what));
    };
    try {
        ProgramOptions build;
        build.math = fast_math ? Math::fast : Math::strict;
        if (probes.device().platform == pocl_platform) build.more = "-Werror";
        probes.launch(build, launch);
    } catch (const cl::Error& error) {
        throw failed(fmt::format("{}: {}", error.what(), cl_status_text(error.err())));
    } catch (const Error& error) {
        throw failed(error.what());
    }
}

/// The most items of a launch that are compared with the native probes.
constexpr std::size_t compared_items = 65536;

}  // namespace

void add_input(ProbeRecord& launch, const void* values, std::size_t bytes,
               std::uint32_t item_bytes) {
    const auto* const first = static_cast<const std::byte*>(values);
    launch.inputs.push_back({{first, first + bytes}, item_bytes});
}

void launch_probe(ProbeRecord& launch) {
    if (is_native_alone()) {
        launch_native(launch, 1);
    } else {
        launch_on_device(launch);
    }
    if (fast_math) return;
    if (!recorded_file().empty()) {
        recorder.add(launch);
    } else {
        expect_native_bits(first_items(launch, compared_items));
    }
}

FastMath::FastMath() { fast_math = true; }
FastMath::~FastMath() { fast_math = false; }

std::string test_device_name() {
    return is_native_alone() ? "pthreads" : probe_environment->open().device().name;
}
bool test_device_has_double() {
    return is_native_alone() || probe_environment->open().device().has_double;
}

}  // namespace rt
