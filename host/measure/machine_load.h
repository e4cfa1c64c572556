// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rt {

/// How busy the machine is with other work.
struct MachineLoad {
    double average = -1;  ///< over one minute; below 0: unknown
    int cores = 1;        ///< available to this process

    double per_core() const { return average / cores; }

    /// Whether it disturbs timings: at least a quarter of each core is in use.
    bool busy() const { return per_core() >= 0.25; }
};

/// The load for this one-minute average, on the cores available.
MachineLoad load_of(double average);

/// One line, or "" where the machine is not busy.
std::string busy_text(const MachineLoad& load);

/// {"load_before", "load_per_core", "busy"}; null where unknown.
nlohmann::ordered_json machine_load_json(const MachineLoad& load);

}  // namespace rt
