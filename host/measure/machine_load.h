// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <istream>
#include <nlohmann/json.hpp>
#include <string>

namespace rt {

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

/// How many of the cores that are available to this process others keep busy, on average: by the
/// first call, over a fifth of a second, in which this process should do nothing; by later ones,
/// that or the one since, whichever is more. Below 0: unknown.
double other_load();

/// One line if this load disturbs timings, for at least a quarter of each core is in use; else "".
std::string busy_text(double load);

/// {"load_before", "load_per_core", "busy"}; null where unknown.
nlohmann::ordered_json machine_load_json(double load);

}  // namespace rt
