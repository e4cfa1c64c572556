// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/options.h"
#include "host/image/output_file.h"
#include "host/measure/timing.h"
#include "host/process/worker.h"
#include "host/selftest/selftest.h"

namespace rt {

namespace {

int run_blame(const std::string& spec, const std::string& folder) {
    const std::vector<DeviceChoice> devices = listed_devices({spec});
    if (devices.size() != 1 || devices[0].use_threads) {
        usage_error("--device {}: blame takes one OpenCL device", spec);
    }
    if (std::filesystem::exists(folder)) {
        check_output_path(folder + "/README");
        if (!std::filesystem::is_empty(folder) &&
            !std::filesystem::exists(folder + "/launch.txt")) {
            throw Error(ExitCode::output, folder + ": holds other files; choose a new folder");
        }
    }
    const DriverTask task(devices[0].name());
    const Blame blame = blame_device(devices[0].device, folder);
    print_result(blame.text);
    if (blame.verdict.empty()) {
        print_result("found nothing wrong; 'mirrorball selftest' checks more\n");
        return 0;
    }
    print_result("to blame: " + blame.verdict + "\n");
    if (!blame.reproducer.empty()) {
        print_result(fmt::format("to see it: cd {} && cc reproduce.c -lOpenCL && ./a.out\n",
                                 blame.reproducer));
    }
    return static_cast<int>(ExitCode::different);
}

}  // namespace

void add_blame(Verb& program, const Invocation&) {
    struct Asked {
        std::string device, folder = "blame";
    };
    const auto asked = std::make_shared<Asked>();
    Verb& verb = program.verb(
        "blame", "find which function, option, pixel or ray a device gets wrong, and reproduce it");
    verb.value("--device", "SPEC", asked->device, parse_device, "the OpenCL device", true);
    verb.value("-o,--output", "FOLDER", asked->folder,
               "folder for a C program that shows the fault (default: blame)");
    add_build_extras(verb);
    verb.run = [asked] { return run_blame(asked->device, asked->folder); };
    verb.measures = true;
    verb.crash = ExitCode::different;
}

}  // namespace rt
