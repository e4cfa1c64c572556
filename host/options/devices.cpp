// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

std::string icd_place() {
    for (const char* name : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) {
        if (const std::string place = environment(name); !place.empty()) return place;
    }
    return "/etc/OpenCL/vendors";
}

void add_devices(const CommandLine& program, Options& options) {
    const CommandLine verb = program.verb("devices", "list usable devices, and why others are not");
    verb.flag("--json", options.devices.json, json_help);
    verb.when_chosen([&] { options.verb = Verb::devices; });
}

}  // namespace rt
