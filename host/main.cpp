// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <functional>
#include <string>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/opencl/pocl.h"
#include "host/options/options.h"
#include "host/picture/render_stats.h"
#include "host/process/drivers.h"
#include "host/process/exit_status.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/verbs/verbs.h"

namespace {

/// Measures in a worker process, which the OpenCL drivers it loads may crash.
int isolated(const rt::RenderOptions& options, double seconds_before_main,
             const std::function<int()>& measure) {
    if (rt::is_worker()) return measure();
    rt::WorkerCommand command{options.command, {}, options.deadline, seconds_before_main};
    const rt::WorkerEnd end = rt::run_without_bad_drivers(command, options.drivers, false);
    if (end.is_regular) return end.status;
    throw rt::Error(rt::ExitCode::device, (end.task.empty() ? "" : end.task + ": ") +
                                              "the worker process " + end.how +
                                              "; test each driver with 'mirrorball doctor'");
}

int run(int argc, char** argv, double seconds_before_main) {
    const rt::Options options = rt::parse_options(argc, argv);
    if (rt::become_worker(options.worker_link)) seconds_before_main += rt::seconds_before_worker();
    if (options.quiet()) rt::stop_quietly();
    const auto in_worker = [&](const std::function<int()>& measure) {
        return isolated(options.render, seconds_before_main, measure);
    };
    switch (options.verb) {
        case rt::Verb::render:
            return rt::run_render(options.render, seconds_before_main);
        case rt::Verb::merge:
            return rt::run_merge(options.merge);
        case rt::Verb::compare:
            return rt::run_compare(options.compare);
        case rt::Verb::bench:
            return in_worker([&] { return rt::run_bench(options.bench); });
        case rt::Verb::converge:
            return in_worker([&] { return rt::run_converge(options.converge); });
        case rt::Verb::stress:
            return in_worker([&] { return rt::run_stress(options.stress); });
        case rt::Verb::report:
            return in_worker([&] { return rt::run_report(options.report); });
        case rt::Verb::devices:
            return rt::run_devices(options.devices);
        case rt::Verb::doctor:
            return rt::run_doctor(options.doctor);
        case rt::Verb::explain:
            return rt::run_explain(options.explain);
        case rt::Verb::scene:
            return rt::run_scene(options.scene);
        case rt::Verb::none:
            rt::print_result(options.text);
            return 0;
    }
    return static_cast<int>(rt::ExitCode::bug);
}

}  // namespace

int main(int argc, char** argv) {
    const double seconds_before_main = rt::seconds_since_process_start();
    rt::open_missing_streams();
    rt::prepare_signals();
    const int status = rt::exit_status_of([&] {
        const int result = run(argc, argv, seconds_before_main);
        rt::flush_results();
        return result;
    });
    rt::note_worker_end(status);
    rt::leave_pocl_cache();
    // Skips destructors: a driver may still be compiling for a picture that is finished.
    _exit(status);
}
