// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/opencl/cl_device.h"

namespace rt {

/// The state of the drivers that .icd files name.
struct IcdFiles {
    std::vector<std::string> usable;    ///< files whose drivers load and list their devices
    std::vector<std::string> problems;  ///< one line for each of the others
    bool any_dangerous = false;         ///< one of those crashes or hangs its process
};

/// Tries each driver in a child process: OpenCL silently skips those that cannot be loaded, and
/// some crash or hang. `place` is an .icd file, or a folder of them. Call it before OpenCL or any
/// thread has started.
IcdFiles try_icd_files(const std::string& place);

/// A folder of only the usable files, for the lifetime of this object.
class UsableIcdFiles {
   public:
    explicit UsableIcdFiles(const IcdFiles& files);

    /// Its name; empty if it could not be created.
    const std::string& place() const { return folder_.name(); }

    /// The environment change ("NAME=value") that leaves dangerous drivers out; empty if there are
    /// none, or only such.
    std::vector<std::string> change() const;

   private:
    TemporaryFolder folder_;
    bool leaves_out_;
};

/// The devices of all drivers, listed in a child process; if one is dangerous, only of the usable
/// ones, also in the processes that this one starts from then on. Drivers that fail together are
/// listed one by one. The devices have no handles. Adds problems of listing to the files'.
std::vector<ClDevice> list_devices_of(IcdFiles& files, const UsableIcdFiles& usable);

}  // namespace rt
