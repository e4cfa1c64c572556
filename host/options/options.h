// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/options/bench_options.h"
#include "host/options/compare_options.h"
#include "host/options/converge_options.h"
#include "host/options/explain_options.h"
#include "host/options/merge_options.h"
#include "host/options/render_options.h"
#include "host/options/report_options.h"
#include "host/options/stress_options.h"

namespace rt {

/// `mirrorball devices`
struct DevicesOptions {
    std::string drivers;  ///< where OpenCL finds its .icd files: a folder, or one of them
    bool json = false;
};

/// `mirrorball doctor`
struct DoctorOptions {
    std::string drivers;          ///< as in DevicesOptions
    std::string library_folders;  ///< LD_LIBRARY_PATH
    std::string device;           ///< empty: everything, each device in its own process
    double deadline = 30;         ///< seconds without progress before a device counts as hung
    bool json = false;
};

/// `mirrorball scene info|check`
struct SceneOptions {
    std::string scene;
    LightOverrides light;
    bool info = true;  ///< else check
    bool json = false;
};

enum class Verb {
    none,
    render,
    merge,
    bench,
    converge,
    devices,
    scene,
    compare,
    report,
    stress,
    doctor,
    explain
};

struct Options {
    Verb verb = Verb::none;
    RenderOptions render;
    MergeOptions merge;
    BenchOptions bench;
    ConvergeOptions converge;
    CompareOptions compare;
    ReportOptions report;
    StressOptions stress;
    DevicesOptions devices;
    DoctorOptions doctor;
    ExplainOptions explain;
    SceneOptions scene;

    /// -q, of whichever verb.
    bool quiet() const {
        return render.quiet || merge.quiet || bench.quiet || converge.quiet || report.quiet ||
               stress.quiet;
    }

    std::string worker_link;  ///< not empty: this process may be a worker (host/process/worker.h)
    std::string text;         ///< help or version, to be printed instead of doing anything
};

/// Reads the command line and the environment, except for what PoCL and MPI look up. Throws Error
/// (ExitCode::usage) for invalid arguments.
Options parse_options(int argc, const char* const* argv);

}  // namespace rt
