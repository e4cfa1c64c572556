// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/opencl/cl_device.h"
#include "host/temporary_folder.h"

namespace rt {

/// What became of the drivers that .icd files name.
struct IcdFiles {
    std::vector<std::string> usable;    ///< files whose drivers load and list their devices
    std::vector<std::string> problems;  ///< a line for each other
    bool any_dangerous = false;         ///< one of those crashes or hangs whoever loads it
};

/// Tries each driver in a child process: OpenCL passes over those that cannot be loaded in silence,
/// and some crash or hang. `place` is an .icd file, or a folder of them. Call it before OpenCL or
/// any thread has started.
IcdFiles try_icd_files(const std::string& place);

/// A folder of the usable files alone, as long as this lives.
class UsableIcdFiles {
   public:
    explicit UsableIcdFiles(const IcdFiles& files);
    const std::string& place() const { return folder_.name(); }

   private:
    TemporaryFolder folder_;
};

/// The devices of all drivers; where one is dangerous, of the usable ones alone, in this process
/// and those that it starts from then on. Problems of listing are added to the files'.
std::vector<ClDevice> list_devices_of(IcdFiles& files, const UsableIcdFiles& usable);

}  // namespace rt
