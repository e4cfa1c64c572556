// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/base/error.h"
#include "host/opencl/cl_renderer.h"
#include "host/record/record.h"
#include "host/selftest/selftest.h"

// The file as it stands, between two symbols.
asm(R"(.pushsection .rodata
.global mirrorball_probes_begin, mirrorball_probes_end
mirrorball_probes_begin: .incbin ")" MIRRORBALL_PROBES_FILE R"("
mirrorball_probes_end:
.popsection)");
extern "C" const unsigned char mirrorball_probes_begin[], mirrorball_probes_end[];

namespace rt {

namespace {

/// One work-group size: PoCL compiles a kernel again for any other.
constexpr std::size_t usual_group = 64;
constexpr std::size_t most_launch_items = 65536 - usual_group;

/// Of the file before it is compressed: {function, is_double, count, {inputs}, {outputs}}, which
/// tests/kernel_runner.cpp writes.
std::vector<ProbeArray> arrays_of(const Json& list) {
    std::vector<ProbeArray> arrays;
    for (const Json& json : list) {
        const auto bytes = std::as_bytes(std::span(json[2].get_binary()));
        arrays.push_back({{bytes.begin(), bytes.end()}, json[0], json[1]});
    }
    return arrays;
}

}  // namespace

std::vector<ProbeRecord> recorded_probes() {
    uLongf size = 0;
    constexpr std::size_t start = sizeof(size);
    std::memcpy(&size, mirrorball_probes_begin, start);
    std::vector<std::uint8_t> plain(size);
    const auto bytes = static_cast<uLong>(mirrorball_probes_end - mirrorball_probes_begin - start);
    if (uncompress(plain.data(), &size, mirrorball_probes_begin + start, bytes) != Z_OK) {
        throw Error(ExitCode::bug, "the records of the probes cannot be read");
    }
    std::vector<ProbeRecord> records;
    for (const Json& json : Json::from_msgpack(plain)) {
        records.push_back({json[0], json[1], json[2], arrays_of(json[3]), arrays_of(json[4])});
    }
    return records;
}

ProbeDevice::ProbeDevice(const ClDevice& device) try
    : device_(device), queue_(programs_.context(device_), handle_of(device_)) {
} catch (const cl::Error& error) {
    throw_device_error(device, error);
}

ProgramOptions probe_program(ProgramOptions build, const ProbeRecord& launch) {
    build.precision = launch.is_double ? Precision::float64 : Precision::float32;
    build.entries = {false, false, false};
    if (!launch.has_scene()) build.more += " -DRT_SCENE_PROBES=0";
    return build;
}

void ProbeDevice::launch(const ProgramOptions& build, ProbeRecord& record) {
    cl::Kernel kernel(programs_.program(device_, probe_kernels, probe_program(build, record)),
                      ("probe_" + record.function).c_str());
    const std::size_t given = 2 + record.inputs.size() + record.outputs.size();
    if (const auto wanted = kernel.getInfo<CL_KERNEL_NUM_ARGS>(); wanted != given) {
        usage_error("the probe takes {} arguments (first, count, ...) and was given {}", wanted,
                    given);
    }
    const cl::Context context = programs_.context(device_);
    std::vector<cl::Buffer> buffers;
    for (const auto* arrays : {&record.inputs, &record.outputs}) {
        for (const auto& [bytes, item_bytes, holds_numbers] : *arrays) {
            // OpenCL has no empty buffers.
            buffers.emplace_back(context, CL_MEM_READ_WRITE,
                                 std::max<std::size_t>(bytes.size(), 1));
            if (!bytes.empty()) {
                queue_.enqueueWriteBuffer(buffers.back(), CL_TRUE, 0, bytes.size(), bytes.data());
            }
            kernel.setArg(static_cast<cl_uint>(1 + buffers.size()), buffers.back());
        }
    }
    kernel.setArg(1, static_cast<cl_uint>(record.count));
    const std::size_t group = fitting_group(kernel, device_, usual_group);
    const std::size_t lanes = static_cast<std::size_t>(build.lanes);
    const std::size_t packets = (record.count + lanes - 1) / lanes;
    const std::size_t most_items = record.in_one_launch ? packets : most_launch_items;
    for (std::size_t first = 0; first < packets; first += most_items) {
        kernel.setArg(0, static_cast<cl_uint>(first));
        const std::size_t items = std::min(packets - first, most_items);
        queue_.enqueueNDRangeKernel(kernel, cl::NullRange, (items + group - 1) / group * group,
                                    group);
    }
    for (std::size_t i = 0; i < record.outputs.size(); ++i) {
        auto& bytes = record.outputs[i].bytes;
        queue_.enqueueReadBuffer(buffers[record.inputs.size() + i], CL_TRUE, 0, bytes.size(),
                                 bytes.data());
    }
}

namespace {

template <typename T>
T number_at(const ProbeArray& array, std::size_t byte) {
    T x;
    std::memcpy(&x, array.bytes.data() + byte, sizeof(T));
    return x;
}

/// |a - b| in ulps of b.
template <typename T>
double ulps_between(T a, T b) {
    const T size = std::abs(b);
    const T ulp = std::max(std::nextafter(size, std::numeric_limits<T>::infinity()) - size,
                           std::numeric_limits<T>::denorm_min());
    return std::abs(double{a} - double{b}) / ulp;
}

/// By how much results differ, in words.
template <typename T>
std::string error_text(const ProbeArray& got, const ProbeArray& right) {
    double worst = 0;
    for (std::size_t at = 0; at < right.bytes.size(); at += sizeof(T)) {
        const T x = number_at<T>(got, at), y = number_at<T>(right, at);
        if (x == y || (std::isnan(x) && std::isnan(y))) continue;
        if (!std::isfinite(x) || !std::isfinite(y)) return ", by far";
        worst = std::max(worst, ulps_between(x, y));
    }
    return worst > 1e6 ? ", by far" : fmt::format(", by up to {:.3g} ulps", worst);
}

template <typename Word>
std::string words(const ProbeArray& array, std::size_t item) {
    constexpr const char* format = std::is_integral_v<Word> ? " {:#x}" : " {:a}";
    std::string text;
    const std::size_t begin = item * array.item_bytes, end = begin + array.item_bytes;
    for (std::size_t at = begin; at + sizeof(Word) <= end; at += sizeof(Word)) {
        text += fmt::format(format, number_at<Word>(array, at));
    }
    return text;
}

template <typename T>
std::string item_text(const ProbeArray& array, std::size_t item) {
    return array.holds_numbers ? words<T>(array, item) : words<std::uint32_t>(array, item);
}

/// Whether the items at `byte` of two results hold the same bits; all NaNs are equal, since IEEE
/// 754 leaves sign and payload to the machine.
template <typename T>
bool is_same_item(const ProbeArray& a, const ProbeArray& b, std::size_t byte) {
    const auto differs = [&](std::size_t at, std::size_t bytes) {
        return std::memcmp(&a.bytes[at], &b.bytes[at], bytes) != 0;
    };
    if (!differs(byte, a.item_bytes)) return true;
    for (std::size_t at = byte; at < byte + a.item_bytes && a.holds_numbers; at += sizeof(T)) {
        const bool both_nan = std::isnan(number_at<T>(a, at)) && std::isnan(number_at<T>(b, at));
        if (!both_nan && differs(at, sizeof(T))) return false;
    }
    return a.holds_numbers;
}

template <typename T>
std::string difference(const ProbeRecord& record, const ProbeArray& got, const ProbeArray& right) {
    std::size_t wrong = 0, first = 0;
    for (std::size_t i = record.count; i-- > 0;) {
        if (is_same_item<T>(got, right, i * right.item_bytes)) continue;
        first = i;
        ++wrong;
    }
    if (wrong == 0) return "";
    const std::string both = item_text<T>(got, first) + " instead of" + item_text<T>(right, first);
    return fmt::format("{} of {} items differ{}; item {}:{}", wrong, record.count,
                       right.holds_numbers ? error_text<T>(got, right) : "", first, both);
}

}  // namespace

std::string difference(const ProbeRecord& right, const ProbeRecord& got) {
    const auto find = right.is_double ? difference<double> : difference<float>;
    for (std::size_t k = 0; k < right.outputs.size(); ++k) {
        std::string found = find(right, got.outputs[k], right.outputs[k]);
        if (!found.empty()) return found;
    }
    return "";
}

std::string what_is_wrong(ProbeDevice& device, const ProbeRecord& record, int lanes,
                          const std::string& more_options) {
    ProbeRecord got = record;
    for (ProbeArray& result : got.outputs) {  // what the kernel must write
        std::ranges::fill(result.bytes, std::byte{0xa5});
    }
    ProgramOptions build;
    build.lanes = lanes;
    build.more = more_options;
    device.launch(build, got);
    return difference(record, got);
}

std::vector<ProbeRecord> checked_probes() {
    std::vector<ProbeRecord> records = recorded_probes();
    ProbeRecord many = *std::ranges::find_if(records, [](const ProbeRecord& one) {
        return one.function == "owen_scramble" && !one.is_double;
    });
    many.in_one_launch = true;
    many.count = (1u << 20) + 4096;
    for (auto* arrays : {&many.inputs, &many.outputs}) {
        for (ProbeArray& array : *arrays) {  // its items over and over
            const std::size_t once = array.bytes.size();
            array.bytes.resize(std::size_t{many.count} * array.item_bytes);
            for (std::size_t i = once; i < array.bytes.size(); ++i) {
                array.bytes[i] = array.bytes[i - once];
            }
        }
    }
    records.push_back(std::move(many));
    return records;
}

std::vector<FunctionCheck> function_checks(std::span<const ProbeRecord> records,
                                           const ClDevice& device, bool quick) {
    std::vector<FunctionCheck> checks;
    for (auto one = records.begin(); one != records.end();) {  // records of a function are together
        const auto last = std::find_if(one, records.end(), [&](const ProbeRecord& other) {
            return other.function != one->function || other.is_double != one->is_double;
        });
        const bool is_slow = one->has_scene() || one->in_one_launch;
        const bool is_left_out =
            quick ? one->is_double || is_slow : one->is_double && (is_slow || !device.has_double);
        const int native =
            one->is_double ? packet_lanes<double>(0, device) : packet_lanes<float>(0, device);
        const int widest = one->in_one_launch ? 1 : native;
        for (const int lanes : std::set<int>{widest, quick || is_slow ? widest : 1}) {
            if (is_left_out) continue;
            const std::string name = one->in_one_launch ? "many-items" : one->function;
            checks.push_back(
                {fmt::format("{}/{}/{}", name, precision_name(*one), lanes), {one, last}, lanes});
        }
        one = last;
    }
    return checks;
}

void check_functions(Checks& checks, const ClDevice& device, const std::string& prefix,
                     bool quick) {
    const std::vector<ProbeRecord> records = checked_probes();
    ProbeDevice probes(device);
    for (const FunctionCheck& check : function_checks(records, device, quick)) {
        checks.run(prefix + check.name, [&] {
            std::string why;
            for (const ProbeRecord& record : check.records) {
                if (why.empty()) why = what_is_wrong(probes, record, check.lanes);
            }
            return why;
        });
    }
}

}  // namespace rt
