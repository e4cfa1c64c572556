// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "host/options/options.h"

namespace rt {

// One function per verb, one file per function: adds the verb to the command line and says where
// its options go.
void add_render(CLI::App& app, Options& options);
void add_compare(CLI::App& app, Options& options);
void add_bench(CLI::App& app, Options& options);
void add_converge(CLI::App& app, Options& options);
void add_stress(CLI::App& app, Options& options);
void add_report(CLI::App& app, Options& options);
void add_devices(CLI::App& app, Options& options);
void add_scene(CLI::App& app, Options& options);

/// --light-scale and --ambient, of every verb that reads scenes.
void add_light_options(CLI::App& verb, LightOverrides& light);

}  // namespace rt
