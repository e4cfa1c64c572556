// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "host/base/console.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/measure/timing.h"
#include "host/opencl/pocl.h"
#include "host/process/drivers.h"
#include "host/record/record.h"
#include "host/render/native_kernels.h"

namespace rt {

namespace {

void print_json(const Drivers& drivers) {
    const Json json{{"format", "mirrorball-devices"},
                    {"version", 1},
                    {"devices", json_of(drivers.devices)},
                    {"threads", {{"cores", available_cores()}, {"isas", native_isas()}}},
                    {"machine", machine_load_json(other_load())},
                    {"problems", drivers.problems}};
    print_result(json_text(json));
}

constexpr double gib = 1 << 30;

std::string device_text(const ClDevice& device) {
    std::string text = fmt::format(
        "{}  {}\n"
        "   {}:{} {} '{}' on {}, driver {}, {}\n"
        "   {}, {}, {}, {:.1f} GiB, largest buffer {:.1f} GiB\n",
        device.index, short_device_name(device.name), device.platform_index, device.device_index,
        device.kind, device.name, device.platform, device.driver, device.version,
        counted(device.compute_units, "unit"), counted(device.float_lanes, "float lane"),
        device.has_double ? counted(device.double_lanes, "double lane") : "no double",
        static_cast<double>(device.memory_bytes) / gib,
        static_cast<double>(device.max_buffer_bytes) / gib);
    if (!device.is_exact(Precision::float32)) {
        text += "   does not guarantee exact rounding in float, so bits may differ\n";
    }
    if (!device.unusable.empty()) text += "   cannot be used: " + device.unusable + "\n";
    return text;
}

/// The line for pthreads: cores, and the instruction sets that have kernels.
std::string threads_text() {
    const std::vector<std::string> isas = native_isas();
    std::string text = "threads  POSIX threads on " + counted(available_cores(), "core");
    if (isas.empty()) return text + ": no kernels for this processor\n";
    text += fmt::format(", kernels for {}", fmt::join(isas, ", "));
    if (!has_fast_fma(isas.front())) text += " (slow: no fused multiply-add)";
    return text + "\n";
}

int run_devices(const std::string& place, bool json) {
    if (is_worker()) {
        list_drivers_for_parent(place);
        return 0;
    }
    prepare_pocl(0);
    Drivers drivers = list_drivers(place);
    drivers.problems.insert(drivers.problems.begin(), drivers.bad_files.begin(),
                            drivers.bad_files.end());
    if (json) {
        print_json(drivers);
        return 0;
    }
    std::string text;
    for (const ClDevice& device : drivers.devices) text += device_text(device);
    text += threads_text();
    for (const std::string& problem : drivers.problems) text += problem + "\n";
    print_result(text);
    return 0;
}

}  // namespace

void add_devices(Verb& program, const Invocation& call) {
    const auto json = std::make_shared<bool>(false);
    Verb& verb = program.verb("devices", "list devices; for unusable ones, say why");
    verb.flag("--json", *json, json_help);
    verb.run = [json, &call] { return run_devices(call.drivers, *json); };
}

}  // namespace rt
