// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/command_line.h"
#include "host/options/options.h"

namespace rt {

// One function per verb, one file per function: adds the verb to the command line and binds its
// options.
void add_render(const CommandLine& program, Options& options);
void add_merge(const CommandLine& program, Options& options);
void add_compare(const CommandLine& program, Options& options);
void add_bench(const CommandLine& program, Options& options);
void add_converge(const CommandLine& program, Options& options);
void add_stress(const CommandLine& program, Options& options);
void add_devices(const CommandLine& program, Options& options);
void add_doctor(const CommandLine& program, Options& options);
void add_explain(const CommandLine& program, Options& options);
void add_scene(const CommandLine& program, Options& options);

/// Where OpenCL's loader looks for its drivers: a folder of .icd files, or one of them.
std::string icd_place();

/// --light-scale and --ambient, for every verb that reads scenes.
void add_light_options(const CommandLine& verb, LightOverrides& light);

/// --preview, --show and --tev.
void add_view_options(const CommandLine& verb, ViewSettings& view);

}  // namespace rt
