// SPDX-License-Identifier: Apache-2.0
#include "host/report/device_colors.h"

#include <algorithm>

namespace rt {

namespace {

constexpr int opencl_colors = 5;  ///< beyond them colors repeat; dashes and labels do not

}  // namespace

DeviceColors::DeviceColors(const std::vector<BenchRow>& rows) {
    for (const BenchRow& row : rows) {
        const std::string& name = row.asked.device_name;
        if (row.asked.uses_threads) continue;
        if (std::find(opencl_.begin(), opencl_.end(), name) == opencl_.end()) {
            opencl_.push_back(name);
        }
    }
}

int DeviceColors::of(const BenchCase& asked) const {
    return asked.uses_threads ? threads : of(asked.device_name);
}

int DeviceColors::of(const ConvergeCase& asked) const {
    return asked.device_name == "threads" ? threads : of(asked.device_name);
}

int DeviceColors::of(const std::string& device_name) const {
    const auto at = std::find(opencl_.begin(), opencl_.end(), device_name) - opencl_.begin();
    return 1 + static_cast<int>(at) % opencl_colors;
}

}  // namespace rt
