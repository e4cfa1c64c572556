// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <string>
#include <vector>

#include "host/opencl/cl_device.h"

namespace rt {

/// What one item of `--device` asks for.
struct DeviceSpec {
    enum class Kind { automatic, threads, all, cpu, gpu, pocl, name, index, place };

    Kind kind = Kind::automatic;
    std::string text{};  ///< as it was given
    std::string name{};  ///< part of a device's, platform's or vendor's name
    int index = 0;       ///< flat, or within its platform
    int platform = 0;
    int threads = 0;  ///< 0: not given

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

    /// Whether strict arithmetic gives the same bits as elsewhere, as far as its driver promises.
    bool is_exact() const { return use_threads || device.rounds_correctly || !failure.empty(); }

    bool has_double() const { return use_threads || device.has_double; }

    /// "threads", or the OpenCL device's own name.
    std::string name() const { return use_threads ? "threads" : device.name; }

    /// For --device: "threads", "threads:2", "0".
    std::string spec() const;
};

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
