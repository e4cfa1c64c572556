// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include "host/opencl/pocl.h"
#include "host/record/describe.h"
#include "host/render/picture_spec.h"

struct _cl_device_id;

namespace rt {

/// An OpenCL device and its relevant properties.
struct ClDevice {
    int index = 0;           ///< flat, as `mirrorball devices` prints it
    int platform_index = 0;  ///< platform, and device within it
    int device_index = 0;
    std::string name, vendor, driver, version, platform;
    std::string kind;  ///< "CPU", "GPU" or "accelerator"
    unsigned compute_units = 0;
    unsigned float_lanes = 0, double_lanes = 0;  ///< native vector widths; 0: no such type
    std::uint64_t memory_bytes = 0, max_buffer_bytes = 0;
    bool has_double = false;
    bool rounds_correctly = false;  ///< promises correctly rounded float division and sqrt
    bool keeps_subnormals = false;  ///< float
    std::string unusable;           ///< why it cannot render; empty when it can
    _cl_device_id* handle = nullptr;

    bool is_cpu() const { return kind == "CPU"; }
    bool is_gpu() const { return kind == "GPU"; }

    /// Whether strict arithmetic gives the same bits as elsewhere, as far as its driver promises.
    /// In double, OpenCL requires it.
    bool is_exact(Precision precision) const {
        return precision == Precision::float64 || (rounds_correctly && keeps_subnormals);
    }
};

template <typename A, Of<ClDevice> X>
void describe(A& a, X& x) {
    a("index", x.index, "");
    a("platform_index", x.platform_index, "");
    a("device_index", x.device_index, "");
    a("name", x.name, "");
    a("vendor", x.vendor, "");
    a("platform", x.platform, "");
    a("driver", x.driver, "");
    a("version", x.version, "");
    a("kind", x.kind, "");
    a("compute_units", x.compute_units, "");
    a("float_lanes", x.float_lanes, "");
    a("double_lanes", x.double_lanes, "");
    a("memory_bytes", x.memory_bytes, "");
    a("max_buffer_bytes", x.max_buffer_bytes, "");
    a("has_double", x.has_double, "");
    a("rounds_correctly", x.rounds_correctly, "");
    a("keeps_subnormals", x.keeps_subnormals, "");
    a("usable", x.unusable.empty(), "");
    a("unusable_because", x.unusable, "");
}

/// What a problem says of a driver without devices, which may just lack its hardware.
inline constexpr const char* no_devices = " has no devices; ";

/// Every OpenCL device, in the loader's order; none when there is no OpenCL.
struct ClDeviceList {
    std::vector<ClDevice> devices;
    std::vector<std::string> problems{};  ///< what went wrong, one line each
    std::string failure{};  ///< the first that a driver reported as an error, not as no device
};

/// Never throws for a missing or broken platform.
ClDeviceList list_cl_devices();

/// What one item of `--device` asks for.
struct DeviceSpec {
    enum class Kind { automatic, threads, all, cpu, gpu, pocl, name, index, place };

    Kind kind = Kind::automatic;
    std::string text{};  ///< as it was given
    std::string name{};  ///< part of a device's, platform's or vendor's name
    int index = 0;       ///< flat, or within its platform
    int platform = 0;
    int threads = 0;  ///< 0: not given, else at most most_threads
    static constexpr int most_threads = 4096;

    bool fits(const ClDevice& device) const;
};

/// Reads a comma-separated list of "auto" or "", "threads", "threads:N", "all" (threads and every
/// usable device), "cpu", "gpu", "pocl", "name:TEXT", "0" and "0:1", whether or not such devices
/// exist. Throws Error (ExitCode::usage).
std::vector<DeviceSpec> parse_device_specs(const std::string& list);

/// The pthreads baseline, or one OpenCL device.
struct DeviceChoice {
    bool use_threads = false;
    int threads = 0;    ///< 0: as many as there are cores, or as settings say
    ClDevice device{};  ///< meaningless for threads
    std::string
        failure{};  ///< why its driver could not list it; then only device.name has a meaning
    bool is_helper = false;  ///< threads added next to an automatically chosen device
    std::string note{};      ///< why it may be unexpected, for stderr; often empty

    bool is_exact(Precision precision) const {
        return use_threads || !failure.empty() || device.is_exact(precision);
    }

    bool has_double() const { return use_threads || device.has_double; }

    /// "threads", or the OpenCL device's own name.
    std::string name() const { return use_threads ? "threads" : device.name; }

    /// For --device: "threads", "threads:2", "0".
    std::string spec() const;
};

/// What to do about a device that gives other bits than threads.
inline const char* advice_on_other_bits(bool is_exact) {
    return is_exact ? "clear its kernel cache or update its driver"
                    : "it does not promise exact rounding: use --math fast";
}

DeviceChoice threads_choice(int threads = 0);

/// Whether OpenCL must be loaded to find the devices of a list: for all but threads, and "auto"
/// where this machine shows no GPU.
bool needs_opencl(const std::string& list);

/// Whether the folder shows device files of a GPU or another accelerator: NVIDIA, AMD compute, WSL,
/// Mali, PowerVR, DRI render or accel nodes.
bool gpu_may_be_here(const std::string& folder = "/dev");

/// The one usable device that a spec fits; for "auto" a GPU or accelerator if there is one, else
/// threads, which start sooner than OpenCL on the same CPU. Throws Error: ExitCode::usage with the
/// candidates if it fits several, ExitCode::device if it fits none or one that cannot be used;
/// "auto" then chooses threads and says so in `note`.
DeviceChoice choose_device(const std::string& spec, const ClDeviceList& list);

/// The devices that a list of specs names, each once.
/// Another thread searches: drivers take time to load (PoCL 0.03 s), and a scene can be read
/// meanwhile. `threads`: for threads and for PoCL; 0: all cores. That thread calls `loaded` after
/// loading drivers. get() throws Error on failure; destroying the future waits until the drivers
/// are loaded.
std::future<std::vector<DeviceChoice>> find_devices(const std::string& list, int threads,
                                                    const std::function<void()>& loaded);

}  // namespace rt
