// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rt {

/// How much the machine has to do next to us.
struct MachineLoad {
    double average = -1;  ///< of one minute; below 0: the system does not tell
    int cores = 1;        ///< that this process may use

    double per_core() const { return average / cores; }

    /// Whether it disturbs timings: a quarter of a core and more of each is taken.
    bool busy() const { return per_core() >= 0.25; }
};

/// The load now, if it is `average`.
MachineLoad load_of(double average);

/// One line, or "" where the machine is not busy.
std::string busy_text(const MachineLoad& load);

/// {"load_before", "load_per_core", "busy"}; null where the system does not tell.
nlohmann::ordered_json machine_load_json(const MachineLoad& load);

}  // namespace rt
