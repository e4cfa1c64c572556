// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/opencl/devices.h"
#include "host/process/worker.h"

// Which OpenCL drivers work is found out in worker processes: the loader silently skips those that
// cannot be loaded, and some crash or hang.
namespace rt {

/// A worker's task while it lists devices.
inline constexpr const char* listing_devices = "listing OpenCL devices";

/// What the drivers that .icd files name offer.
struct Drivers {
    std::vector<std::string> files;      ///< whose drivers load and list their devices
    std::vector<std::string> bad_files;  ///< a line on what is wrong with each of the others
    std::vector<ClDevice> devices;       ///< without handles
    std::vector<std::string> problems;   ///< of listing them, one line each

    /// The OCL_ICD_VENDORS that leaves out drivers that crash or hang; empty if there are none, or
    /// only such.
    std::string place;

    std::unique_ptr<TemporaryFolder> folder;  ///< `place`: links to the files
};

/// Lists the devices of all drivers in a worker; if it fails, each driver's in one of its own, to
/// leave out those that fail. Of drivers that fail only together, none is listed. `place` is an
/// .icd file, or a folder of them; `deadline` as in WorkerCommand. Ends this process if a stop
/// signal ended a worker.
Drivers list_drivers(const std::string& place, double deadline = 10);

/// Libraries of GPU drivers that no .icd file names: containers often get only these. `folders`:
/// where to look besides the usual ones, with colons between them.
std::vector<std::string> unlisted_drivers(const std::string& place, const std::string& folders);

/// Lists drivers in the worker. Call it before OpenCL or any thread has started.
void list_drivers_for_parent(const std::string& place);

/// Runs the command in a worker. If that fails while it lists devices: names the drivers that do,
/// and runs it once more without them, if there are others. Returns how the last worker ended;
/// ends this process if a stop signal ended that before it could say so.
WorkerEnd run_without_bad_drivers(const WorkerCommand& command, const std::string& place,
                                  bool is_quiet);

}  // namespace rt
