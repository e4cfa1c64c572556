// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench_result.h"
#include "host/measure/converge_result.h"

namespace rt {

/// The color of each device in the page's style, the same in every chart. Threads, however many,
/// have the first; OpenCL devices the next ones, in the order of the benchmark's rows.
class DeviceColors {
   public:
    static constexpr int threads = 0;
    static constexpr int no_device = 6;  ///< for curves other than devices: neutral ink

    explicit DeviceColors(const std::vector<BenchRow>& rows);

    int of(const BenchCase& asked) const;
    int of(const ConvergeCase& asked) const;

   private:
    int of(const std::string& device_name) const;

    std::vector<std::string> opencl_;
};

}  // namespace rt
