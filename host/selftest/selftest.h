// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "host/opencl/opencl.h"
#include "host/picture/render_picture.h"
#include "host/record/describe.h"

// What `mirrorball selftest` and `blame` do. The probes of device functions
// (kernels/probes/probes.cl) run on a device; what the kernel tests gave to them and natively got
// back in strict arithmetic is part of the program, recorded by scripts/record-probes.
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

struct Check {
    std::string name;  ///< "dot3/float/16": what is checked, precision, lanes
    std::string why;   ///< what is wrong; empty: nothing
    double seconds = 0;
    bool is_known = false;  ///< to fail, by --expect

    bool is_expected() const { return why.empty() != is_known; }
};

template <typename A, Of<Check> X>
void describe(A& a, X& x) {
    a("name", x.name, "what is checked, precision, rays of a packet");
    a("right", x.why.empty(), "whether it is");
    a("why", unless_empty(x.why), "what is wrong");
    a("known", x.is_known, "whether --expect says that it fails");
    a("seconds", x.seconds, "that it took, compiling included");
}

/// The checks of `mirrorball selftest`, run one after the other.
class Checks {
   public:
    /// Runs those whose names fit a glob, or all if there is none. `known`: which fail.
    Checks(std::vector<std::string> filters, std::set<std::string> known)
        : filters_(std::move(filters)), known_(std::move(known)) {}

    /// Runs a check, unless a filter or a stop signal leaves it out; `check` returns what is wrong,
    /// or nothing. An Error and a cl::Error are wrong, too.
    void run(const std::string& name, const std::function<std::string()>& check);

    /// Adds a finished one, which a worker tells its parent, too.
    void add(Check done);

    const std::vector<Check>& list() const { return list_; }

    bool is_all_expected() const;

    std::string text(double seconds) const;  ///< a line for each failure or surprise, one for all
    std::string json(double seconds, const std::vector<ClDevice>& devices) const;
    std::string junit(double seconds) const;

   private:
    bool wants(const std::string& name) const;

    std::vector<std::string> filters_;
    std::set<std::string> known_;
    std::vector<Check> list_;
};

/// The names in a file of --expect, one a line; # starts a comment. Throws Error (input).
std::set<std::string> known_failures(const std::string& file);

/// How the results of a launch differ from the right ones, NaNs being equal; empty if in nothing.
std::string difference(const ProbeRecord& right, const ProbeRecord& got);

/// Runs a record's probe and compares. Throws as ProbeDevice::launch.
std::string what_is_wrong(ProbeDevice& device, const ProbeRecord& record, int lanes,
                          const std::string& more_options = "");

/// The name of a record's precision.
inline const char* precision_name(const ProbeRecord& record) {
    return record.is_double ? "double" : "float";
}

/// The records of a function in one precision, to be run in packets of so many rays.
struct FunctionCheck {
    std::string name;  ///< "dot3/float/16"
    std::span<const ProbeRecord> records;
    int lanes;
};

/// recorded_probes and a launch of more than 2^20 work items.
std::vector<ProbeRecord> checked_probes();

/// The checks of these records on a device, those that take scenes and the many items last.
std::vector<FunctionCheck> function_checks(std::span<const ProbeRecord> records,
                                           const ClDevice& device, bool quick);

/// A shipped scene as its golden picture shows it.
struct GoldenPicture {
    std::string scene;  ///< "cornell-box": its file in scenes/
    std::string mode;   ///< of anti-aliasing
    Precision precision = Precision::float32;
    std::string hash;  ///< empty: not in scenes/golden.json

    std::string name() const;
};

/// Of all shipped scenes, in float and then in double. Throws Error (input) where they are not
/// installed.
std::vector<GoldenPicture> golden_pictures();

/// The scene at the picture's size, with its AA mode.
Scene golden_scene(const GoldenPicture& picture);

/// Renders it on that device alone; the cache may be null.
RenderedPicture render_golden(const GoldenPicture& picture, const DeviceChoice& device,
                              const KernelChoice& kernels, RenderCache* cache);

// What `selftest` checks on a device. `prefix`: of the names; `quick`: what takes some 20 s with a
// cold kernel cache.
void check_functions(Checks& checks, const ClDevice& device, const std::string& prefix, bool quick);
void check_pictures(Checks& checks, const DeviceChoice& device, const std::string& prefix,
                    bool quick);
void check_stress(Checks& checks, const std::string& spec, const std::string& prefix);

struct Blame {
    std::string verdict;     ///< what is to blame; empty: nothing is found
    std::string text;        ///< what was tried, and what came out
    std::string reproducer;  ///< folder with a program that shows it; empty: none
};

/// Finds out what a device computes wrongly: a function, else what whole kernels have in common
/// that render a wrong picture. Writes a reproducer to the folder. Throws Error.
Blame blame_device(const ClDevice& device, const std::string& folder);

}  // namespace rt
