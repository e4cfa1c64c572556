// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/version.h"
#include "host/cli/options.h"
#include "host/opencl/pocl.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"

namespace rt {

namespace {

constexpr double deadline = 10;  ///< seconds without progress after which a driver counts as hung

/// Where OpenCL's loader looks for its drivers: a folder of .icd files, or one of them.
std::string icd_place() {
    for (const char* name : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) {
        if (const std::string place = environment(name); !place.empty()) return place;
    }
    return "/etc/OpenCL/vendors";
}

/// Measures in a worker process, which the OpenCL drivers it loads may crash.
int run_in_worker(const Verb& verb, const Invocation& call) {
    const WorkerCommand command{call.command, "", deadline, call.seconds_before_main};
    const WorkerEnd end = run_without_bad_drivers(command, call.drivers, false);
    if (end.is_regular) return end.status;
    end_if_stopped(end);
    const std::string message = (end.task.empty() ? "" : end.task + ": ") + "the worker process " +
                                end.how + "; test each driver with 'mirrorball doctor'";
    const bool is_check = !end.records.empty() || end.task.find('/') != std::string::npos;
    if (!verb.crashed || !is_check) throw Error(verb.crash, message);
    print_error(message.c_str());
    return verb.crashed(end);
}

int run(int argc, char** argv, double seconds_before_main) {
    become_worker();
    Verb program("mirrorball",
                 "a headless OpenCL ray tracer that measures its own speed and error");
    Invocation call;
    call.command.assign(argv, argv + argc);
    call.drivers = icd_place();
    call.seconds_before_main = seconds_before_main + seconds_before_worker();
    for (AddVerb* const add : all_verbs) add(program, call);
    Verb& verb =
        read_command_line(program, fmt::format("mirrorball {} ({})", version, git_revision),
                          {argv + 1, argv + std::max(argc, 1)});
    if (verb.given("-q")) stop_quietly();
    return verb.measures && !is_worker() ? run_in_worker(verb, call) : verb.run();
}

/// Also prints the results so far: main ends without closing the streams.
int failed(ExitCode code, const char* message) {
    std::fflush(stdout);
    print_error(message);
    return static_cast<int>(code);
}

/// Returns the exit status, for an exception its exit code.
int run_and_report(int argc, char** argv, double seconds_before_main) try {
    const int status = run(argc, argv, seconds_before_main);
    flush_results();
    return status;
} catch (const Error& error) {
    return failed(error.exit_code(), error.what());
} catch (const std::bad_alloc&) {
    return failed(ExitCode::limit, out_of_memory);
} catch (const std::system_error& error) {
    return failed(ExitCode::limit, error.what());
} catch (const std::exception& error) {
    return failed(ExitCode::bug, error.what());
}

}  // namespace

}  // namespace rt

int main(int argc, char** argv) {
    const double seconds_before_main = rt::seconds_since_process_start();
    rt::open_missing_streams();
    rt::prepare_signals();
    const int status = rt::run_and_report(argc, argv, seconds_before_main);
    rt::note_worker_end(status);
    rt::leave_pocl_cache();
    // Skips destructors: a driver may still be compiling for a picture that is finished.
    _exit(status);
}
