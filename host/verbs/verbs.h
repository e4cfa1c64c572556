// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/options.h"

namespace rt {

// One function per verb, one file per function. Each returns the program's exit status (an
// ExitCode, or 128 + signal when stopped) and throws Error.
int run_render(const RenderOptions& options, double seconds_before_main);
int run_merge(const MergeOptions& options);
int run_compare(const CompareOptions& options);
int run_bench(const BenchOptions& options);
int run_converge(const ConvergeOptions& options);
int run_stress(const StressOptions& options);
int run_devices(const DevicesOptions& options);
int run_doctor(const DoctorOptions& options);
int run_explain(const ExplainOptions& options);
int run_scene(const SceneOptions& options);

}  // namespace rt
