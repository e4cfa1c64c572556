// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <istream>
#include <nlohmann/json.hpp>
#include <string>

namespace rt {

/// How busy other programs keep the cores that are available to this process.
struct MachineLoad {
    double average = -1;  ///< so many of them; below 0: unknown
    int cores = 1;        ///< available to this process

    double per_core() const { return average / cores; }

    /// Whether it disturbs timings: at least a quarter of each core is in use.
    bool busy() const { return per_core() >= 0.25; }
};

/// Seconds since some moment.
struct CoreTimes {
    double wall = 0;
    double used = 0;  ///< of the cores available, by all programs; below 0: unknown
    double own = 0;   ///< by this process
};

/// What all programs have used of these cores, by /proc/stat: "cpu0 user nice system idle iowait
/// irq softirq steal ..." in ticks. Below 0 if one is missing.
double used_seconds(std::istream& stat, const cpu_set_t& which);

/// The average that other programs kept busy.
double load_between(const CoreTimes& from, const CoreTimes& to);

/// The load for this average, on the cores available.
MachineLoad load_of(double average);

/// The average: by the first call, over a fifth of a second, in which this process should do
/// nothing; by later ones, that or the one since, whichever is more. Below 0: unknown.
double other_load();

/// One line, or "" where the machine is not busy.
std::string busy_text(const MachineLoad& load);

/// {"load_before", "load_per_core", "busy"}; null where unknown.
nlohmann::ordered_json machine_load_json(const MachineLoad& load);

}  // namespace rt
