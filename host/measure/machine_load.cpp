// SPDX-License-Identifier: Apache-2.0
#include "host/measure/machine_load.h"

#include <fmt/format.h>

#include "host/base/parallel.h"
#include "host/base/text.h"

namespace rt {

using Json = nlohmann::ordered_json;

MachineLoad load_of(double average) { return {average, available_cores()}; }

std::string busy_text(const MachineLoad& load) {
    if (!load.busy()) return "";
    return fmt::format("busy machine (load {:.1f} on {}, {:.2f} per core): do not quote timings",
                       load.average, counted(static_cast<std::size_t>(load.cores), "core"),
                       load.per_core());
}

Json machine_load_json(const MachineLoad& load) {
    if (load.average < 0)
        return {{"load_before", nullptr}, {"load_per_core", nullptr}, {"busy", nullptr}};
    return {
        {"load_before", load.average}, {"load_per_core", load.per_core()}, {"busy", load.busy()}};
}

}  // namespace rt
