// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/command_line.h"

namespace rt {

/// What the command line asks for, and where the program runs.
struct Invocation {
    std::vector<std::string> command;  ///< the program's own, to start workers
    std::string drivers;  ///< where OpenCL finds its .icd files: a folder, or one of them
    double seconds_before_main = 0;

    std::function<int()> run;           ///< returns the exit status: an ExitCode, or 128 + a signal
    bool measures = false;              ///< to be run in a worker process, for drivers may crash
    ExitCode crash = ExitCode::device;  ///< what a crash of that process means
    bool quiet = false;                 ///< -q

    void here(std::function<int()> verb, bool is_quiet = false) {
        run = std::move(verb);
        quiet = is_quiet;
    }
    void in_worker(std::function<int()> verb, bool is_quiet) {
        here(std::move(verb), is_quiet);
        measures = true;
    }
};

/// Adds a verb to the command line; when it is chosen, sets `call.run`. One file per verb.
using AddVerb = void(Verb& program, Invocation& call);

AddVerb add_render, add_merge, add_compare, add_bench, add_converge, add_stress, add_report,
    add_devices, add_doctor, add_explain, add_scene, add_selftest, add_blame;

}  // namespace rt
