// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "host/base/text.h"
#include "host/report/html.h"
#include "host/report/plot_axis.h"
#include "host/report/sections.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

std::string key_text(const std::string& key) {
    static const std::map<std::string, std::string> names{
        {"git_revision", "git revision"}, {"cpu", "processor"},       {"cores", "cores used"},
        {"memory_bytes", "memory"},       {"os", "operating system"}, {"load", "load afterwards"}};
    const auto name = names.find(key);
    return name == names.end() ? key : name->second;
}

std::string value_text(const std::string& key, const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_null()) return "unknown";
    if (key == "memory_bytes") {
        return significant(value.get<double>() / (1 << 30), 3) + "\u00a0GiB";
    }
    return value.is_number_float() ? significant(value.get<double>(), 2) : value.dump();
}

std::string device_text(const DeviceStats& device) {
    return fmt::format("{}, {}, driver {}, per {}, {}", device.name, device.platform, device.driver,
                       device.launch, counted(device.lanes, "lane"));
}

}  // namespace

std::string environment_section(const Report& report) {
    HtmlTable table{"The machine and the program behind every number", {"what", "value"}, {}};
    for (const auto& [key, value] : report.environment.items()) {
        if (key == "load" && report.load_before >= 0) {
            table.rows.push_back({{"load before", ""}, {significant(report.load_before, 2), ""}});
        }
        table.rows.push_back(
            {{key_text(key), ""}, {value_text(key, value), "environment#/" + key}});
    }
    std::vector<std::string> devices;
    for (const BenchRow& row : report.scenes.front().bench.rows) {
        if (row.repeats.empty() || row.asked.uses_threads) continue;
        const std::string text = device_text(row.repeats.front().device);
        if (std::find(devices.begin(), devices.end(), text) != devices.end()) continue;
        devices.push_back(text);
        table.rows.push_back({{"OpenCL device", ""}, {text, ""}});
    }
    table.rows.push_back({{"created", ""}, {report.date, ""}});
    return "<h2 id=\"machine\">Environment</h2>\n<div class=\"facts\">" + html_table(table) +
           "</div>\n";
}

}  // namespace rt
