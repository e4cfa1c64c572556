// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/console.h"
#include "host/parallel.h"
#include "host/render/cl_device.h"
#include "host/report/stats_json.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

const char* kind_of(const ClDevice& device) {
    return device.is_gpu ? "GPU" : (device.is_cpu ? "CPU" : "accelerator");
}

nlohmann::ordered_json to_json(const ClDevice& device) {
    return {{"index", device.index},
            {"platform_index", device.platform_index},
            {"device_index", device.device_index},
            {"name", device.name},
            {"vendor", device.vendor},
            {"platform", device.platform},
            {"driver", device.driver},
            {"version", device.version},
            {"kind", kind_of(device)},
            {"compute_units", device.compute_units},
            {"float_lanes", device.float_lanes},
            {"double_lanes", device.double_lanes},
            {"memory_bytes", device.memory_bytes},
            {"max_buffer_bytes", device.max_buffer_bytes},
            {"has_double", device.has_double},
            {"rounds_correctly", device.rounds_correctly},
            {"keeps_subnormals", device.keeps_subnormals},
            {"usable", device.unusable.empty()},
            {"unusable_because", device.unusable}};
}

void print_json(const std::vector<ClDevice>& devices, const std::vector<std::string>& problems) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ClDevice& device : devices) list.push_back(to_json(device));
    const nlohmann::ordered_json json{{"format", "mirrorball-devices"},
                                      {"version", 1},
                                      {"devices", list},
                                      {"threads", {{"cores", available_cores()}}},
                                      {"problems", problems}};
    print_result(json_text(json));
}

constexpr double gib = 1 << 30;

std::string device_text(const ClDevice& device) {
    std::string text = fmt::format(
        "{}  {}\n"
        "   {}:{} {} on {}, driver {}, {}\n"
        "   {} units, {} float lanes, {}, {:.1f} GiB, {:.1f} GiB in one piece\n",
        device.index, device.name, device.platform_index, device.device_index, kind_of(device),
        device.platform, device.driver, device.version, device.compute_units, device.float_lanes,
        device.has_double ? fmt::format("{} double lanes", device.double_lanes) : "no double",
        static_cast<double>(device.memory_bytes) / gib,
        static_cast<double>(device.max_buffer_bytes) / gib);
    if (!device.rounds_correctly) {
        text += "   does not promise correctly rounded division: bits may differ\n";
    }
    if (!device.unusable.empty()) text += "   cannot be used: " + device.unusable + "\n";
    return text;
}

}  // namespace

int run_devices(const DevicesOptions& options) {
    std::vector<std::string> problems;
    const std::vector<ClDevice> devices = list_cl_devices(problems);
    if (options.json) {
        print_json(devices, problems);
        return 0;
    }
    std::string text;
    for (const ClDevice& device : devices) text += device_text(device);
    const int cores = available_cores();
    text += fmt::format("threads  POSIX threads on {} core{}\n", cores, cores == 1 ? "" : "s");
    for (const std::string& problem : problems) text += problem + "\n";
    print_result(text);
    return 0;
}

}  // namespace rt
