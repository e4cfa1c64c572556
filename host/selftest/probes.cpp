// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/probes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "host/base/error.h"
#include "host/record/record.h"

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
constexpr std::size_t group = 64;
constexpr std::size_t most_launch_items = 65536 - group;

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

ProbeDevice::ProbeDevice(const ClDevice& device)
    : device_(device), queue_(programs_.context(device_), handle_of(device_)) {}

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

}  // namespace rt
