// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/opencl/cl_device.h"

namespace rt {

/// What `--device` names: the pthreads baseline, or one OpenCL device.
struct DeviceChoice {
    bool use_threads = false;
    int threads = 0;      ///< from threads:N; 0 when not given
    ClDevice device;      ///< meaningless for threads
    std::string failure;  ///< why its driver could not list it; then only device.name has a meaning
    bool is_helper = false;  ///< threads added next to an automatically chosen device
    std::string note;        ///< why it may be unexpected, for stderr; often empty
};

/// Whether the text names the pthreads baseline ("threads" or "threads:N"), which needs no OpenCL.
/// Throws Error (ExitCode::usage) for threads:0 and the like.
bool names_threads(const std::string& spec, DeviceChoice& choice);

/// The spec that names threads and every usable device.
inline constexpr std::string_view all_devices = "all";

/// As many threads as there are cores, or as settings say.
DeviceChoice threads_choice();

/// Whether the text leaves the choice to the program: "auto" or "".
bool is_auto(const std::string& spec);

/// The choice, if it does not require loading OpenCL: threads if the text names them, or if it is
/// automatic and this machine shows no GPU. Throws like names_threads.
std::optional<DeviceChoice> choose_without_opencl(const std::string& spec);

/// The specs of a comma-separated list. Throws Error (ExitCode::usage) if one of several is empty.
std::vector<std::string> specs_of(const std::string& list);

/// Whether finding the devices of a list needs OpenCL. Throws like names_threads.
bool needs_opencl(const std::string& list);

/// Throws Error (ExitCode::usage) unless the text is a spec or a comma-separated list of them,
/// whether or not such devices exist.
void check_device_list(const std::string& list);

/// The devices that a comma-separated list of specs names.
/// Another thread searches: drivers take time to load (PoCL 0.03 s), and a scene can be read
/// meanwhile. `threads`: for threads and for PoCL; 0: all cores. That thread calls `loaded` after
/// loading drivers. get() throws Error on failure; destroying the future waits until the drivers
/// are loaded.
std::future<std::vector<DeviceChoice>> find_devices(const std::string& list, int threads,
                                                    const std::function<void()>& loaded);

/// Chooses among the devices: "0", "0:1", "pocl", "name:TEXT", "cpu", "gpu", or "auto": a
/// GPU or accelerator if there is one, else threads, which start sooner than OpenCL on the same
/// CPU. Text must fit exactly one usable device, else Error (ExitCode::usage) lists the candidates;
/// a device that cannot be used is Error (ExitCode::device) with the reason; "auto" then chooses
/// threads and says so in `note`.
DeviceChoice choose_device(const std::string& spec, const std::vector<ClDevice>& devices,
                           const std::vector<std::string>& problems);

}  // namespace rt
