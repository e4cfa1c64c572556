// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/selftest.h"

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/cli/options.h"
#include "host/measure/timing.h"
#include "host/print/print_run.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"

namespace rt {

namespace {

/// `mirrorball selftest`
struct SelftestOptions {
    std::vector<std::string> devices;  ///< empty: every usable OpenCL device
    std::vector<std::string> filters;  ///< globs of names; empty: all
    ResultFiles results;
    std::string expect;  ///< file of checks that are known to fail; empty: none
    bool quick = false;
    bool quiet = false;
};

/// Throws Error (ExitCode::device) where there is none.
std::vector<DeviceChoice> chosen_devices(const std::vector<std::string>& specs) {
    try {
        if (!specs.empty()) return listed_devices(specs);
        std::vector<DeviceChoice> devices = listed_devices({"all"});
        std::erase_if(devices, [](const DeviceChoice& device) { return device.use_threads; });
        if (!devices.empty()) return devices;
    } catch (const Error& error) {
        throw Error(ExitCode::device, error.what());
    }
    throw Error(ExitCode::device, "no usable OpenCL device; see 'mirrorball doctor'");
}

int report(const SelftestOptions& options, const Checks& checks, double seconds,
           const std::vector<ClDevice>& devices) {
    if (!options.results.take_stdout()) print_result(checks.text(seconds));
    options.results.write("--json", [&] { return checks.json(seconds, devices); });
    options.results.write("--junit", [&] { return checks.junit(seconds); });
    return static_cast<int>(checks.is_all_expected() ? ExitCode::done : ExitCode::different);
}

/// Reports the checks that a worker told before it died, and the one in which it did.
int report_crash(const SelftestOptions& options, const WorkerEnd& end) {
    Checks checks({}, known_failures(options.expect));
    double seconds = 0;
    for (const std::string& record : end.records) {
        const Json told = Json::parse(record);
        checks.add({told.at("name"), told.value("why", ""), told.at("seconds")});
        seconds += checks.list().back().seconds;
    }
    checks.add({end.task, "the worker process " + end.how, 0});
    return report(options, checks, seconds, {});
}

int run_selftest(const SelftestOptions& options) {
    options.results.check({options.expect}, {});
    const Stopwatch watch;
    Checks checks(options.filters, known_failures(options.expect));
    const std::vector<DeviceChoice> devices = chosen_devices(options.devices);
    std::vector<ClDevice> checked;
    for (const DeviceChoice& device : devices) {
        if (!device.use_threads) checked.push_back(device.device);
        const std::string prefix = devices.size() > 1 ? device.spec() + ":" : "";
        if (!options.quiet) print_note("checking " + device.name());
        if (!device.use_threads) {
            check_functions(checks, device.device, prefix, options.quick);
        }
        check_pictures(checks, device, prefix, options.quick);
        if (!options.quick) check_stress(checks, device.spec(), prefix);
    }
    if (stop_flag() != 0) return 128 + stop_flag();
    if (checks.list().empty())
        usage_error(
            "--filter fits no check{}",
            devices.size() > 1 ? "; of several devices, names begin with theirs: '0:dot3/*'" : "");
    return report(options, checks, watch.seconds(), checked);
}

}  // namespace

void add_selftest(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<SelftestOptions>();
    SelftestOptions& selftest = *asked;
    Verb& verb = program.verb(
        "selftest", "check every device function, the golden pictures and quick stress cases");
    verb.value("--device", "SPEC,..", selftest.devices, list_of(parse_device),
               "devices as for render --device (default: as the environment says, else every "
               "OpenCL device)");
    verb.flag("--quick", selftest.quick, "only what takes some 20 s with a cold kernel cache");
    verb.value("--filter", "GLOB,...", selftest.filters, list_of(parse_text),
               "names of checks to run, such as dot3/* (default: all)");
    verb.value("--expect", "FILE", selftest.expect,
               "names of checks known to fail, one a line: that one of them passes is an error");
    selftest.results.add(verb, "--json", json_start("selftest"),
                         "write JSON, to FILE or to stdout");
    selftest.results.add(verb, "--junit", "<?xml", "write JUnit's XML, to FILE or to stdout");
    add_build_extras(verb);
    verb.flag("-q,--quiet", selftest.quiet, quiet_help);
    verb.measures = true;
    verb.crash = ExitCode::different;
    verb.crashed = [asked](const WorkerEnd& end) { return report_crash(*asked, end); };
    verb.run = [asked] {
        if (asked->devices.empty()) {
            const std::string device = device_from_environment();
            if (!device.empty()) asked->devices = split_list(device);
        }
        return run_selftest(*asked);
    };
}

}  // namespace rt
