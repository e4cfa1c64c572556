// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "host/opencl/cl_program.h"

// The probes of device functions (kernels/probes/probes.cl) on a device, and what the kernel tests
// gave to them and natively got back in strict arithmetic: recorded by scripts/record-probes, part
// of the program.
namespace rt {

/// An argument of a probe.
struct ProbeArray {
    std::vector<std::byte> bytes;
    std::uint32_t item_bytes = 0;  ///< 0: the same for all items
    bool holds_numbers = true;     ///< of a result, possibly among integers; else integers only
};

/// One launch of probe_FUNCTION over `count` items.
struct ProbeRecord {
    std::string function;
    bool is_double = false;
    std::uint32_t count = 0;
    std::vector<ProbeArray> inputs, outputs;
    bool in_one_launch = false;  ///< however many items there are

    /// A scene is ten inputs. Probes that take one are a program of their own: they hold much of
    /// the tracer, and take long to compile.
    bool has_scene() const { return inputs.size() >= 10; }
};

/// A function's one after the other, those that take scenes last.
std::vector<ProbeRecord> recorded_probes();

/// kernels/probes/probes.cl with its includes, embedded at build time.
extern const char* const probe_kernels;

/// The options of a launch, in its precision.
ProgramOptions probe_program(ProgramOptions build, const ProbeRecord& launch);

/// A device with the probes, each build of them made on first use.
class ProbeDevice {
   public:
    explicit ProbeDevice(const ClDevice& device);

    const ClDevice& device() const { return device_; }

    /// Runs probe_FUNCTION over `count` items in packets of build.lanes; its arguments are first,
    /// count, the inputs and the outputs, which are uploaded before and get the results.
    /// Throws cl::Error, and Error as build_program does.
    void launch(const ProgramOptions& build, ProbeRecord& record);

   private:
    ClDevice device_;
    OpenDevices programs_;
    cl::CommandQueue queue_;
};

}  // namespace rt
