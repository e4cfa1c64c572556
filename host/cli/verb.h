// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/cli/command_line.h"

namespace rt {

/// How the program was started, and where it runs.
struct Invocation {
    std::vector<std::string> command;  ///< the program's own, to start workers
    std::string drivers;  ///< where OpenCL finds its .icd files: a folder, or one of them
    double seconds_before_main = 0;
};

/// Adds a verb to the command line, which refers to `call`. One file per verb.
using AddVerb = void(Verb& program, const Invocation& call);

AddVerb add_render, add_merge, add_compare, add_bench, add_converge, add_stress, add_report,
    add_devices, add_doctor, add_explain, add_scene, add_selftest, add_blame;

}  // namespace rt
