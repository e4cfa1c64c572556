// SPDX-License-Identifier: Apache-2.0
#include "host/measure/machine_load.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/render/stopwatch.h"

namespace rt {

using Json = nlohmann::ordered_json;

namespace {

CoreTimes core_times() {
    static const Stopwatch watch;
    cpu_set_t ours;
    if (sched_getaffinity(0, sizeof ours, &ours) != 0) return {watch.seconds(), -1, 0};
    std::ifstream stat("/proc/stat");
    return {watch.seconds(), used_seconds(stat, ours), processor_seconds()};
}

bool is_busy(double load) { return load / available_cores() >= 0.25; }

}  // namespace

double used_seconds(std::istream& stat, const cpu_set_t& which) {
    double ticks = 0;
    int cores = 0;
    for (std::string line; std::getline(stat, line);) {
        std::size_t core = 0;
        double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, softirq = 0, steal = 0;
        std::istringstream fields(line.starts_with("cpu") ? line.substr(3) : "");
        if (line.starts_with("cpu ") || !(fields >> core) || !CPU_ISSET(core, &which)) continue;
        fields >> user >> nice >> system >> idle >> wait >> irq >> softirq >> steal;
        ticks += user + nice + system + irq + softirq + steal;
        ++cores;
    }
    return cores < CPU_COUNT(&which) ? -1 : ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double load_between(const CoreTimes& from, const CoreTimes& to) {
    if (from.used < 0 || to.used < 0) return -1;
    const double others = to.used - from.used - (to.own - from.own);
    return std::max(others / (to.wall - from.wall), 0.0);
}

double other_load() {
    static const CoreTimes first = core_times();
    static const double before = [] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return load_between(first, core_times());
    }();
    return std::max(before, load_between(first, core_times()));
}

std::string busy_text(double load) {
    if (!is_busy(load)) return "";
    return fmt::format(
        "busy machine (others use {:.1f} of {}, {:.2f} per core): do not quote timings", load,
        counted(static_cast<std::size_t>(available_cores()), "core"), load / available_cores());
}

Json machine_load_json(double load) {
    if (load < 0) return {{"load_before", nullptr}, {"load_per_core", nullptr}, {"busy", nullptr}};
    return {{"load_before", load},
            {"load_per_core", load / available_cores()},
            {"busy", is_busy(load)}};
}

}  // namespace rt
