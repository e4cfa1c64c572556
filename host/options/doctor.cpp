// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/device_spec.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

void add_doctor(const CommandLine& program, Options& options) {
    DoctorOptions& doctor = options.doctor;
    const CommandLine verb = program.verb(
        "doctor", "test the installation: drivers, devices, caches, formats; say how to fix it");
    verb.flag("--json", doctor.json, "as JSON on stdout");
    verb.option("--device", "SPEC", "test only this device, in this process",
                [&](const std::string& text) {
                    check_device_list(text);
                    doctor.device = text;
                });
    verb.option(
        "--deadline", "S",
        "seconds without progress, or a tenth of a test's time, after which a device counts as "
        "hung (default 30)",
        [&](const std::string& text) { doctor.deadline = parse_seconds("--deadline", text, 0.5); });
    verb.when_chosen([&options] { options.verb = Verb::doctor; });
}

}  // namespace rt
