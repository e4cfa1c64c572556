// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

void add_doctor(const CommandLine& program, Options& options) {
    DoctorOptions& doctor = options.doctor;
    const CommandLine verb = program.verb(
        "doctor",
        "check the installation (drivers, devices, caches, formats) and suggest how to fix it");
    doctor.library_folders = environment("LD_LIBRARY_PATH");
    verb.flag("--json", doctor.json, json_help);
    verb.value("--device", "SPEC", doctor.device, parse_device,
               "check only this device, in this process");
    verb.value("--deadline", "S", doctor.deadline, seconds_from(0.1),
               "seconds without progress after which a device counts as hung; its test may take "
               "ten times as long (default: 30)");
    verb.when_chosen([&options] { options.verb = Verb::doctor; });
}

}  // namespace rt
