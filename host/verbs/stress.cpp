// SPDX-License-Identifier: Apache-2.0

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/image/output_path.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/print/print_stress.h"
#include "host/print/result_file.h"
#include "host/process/stop_signal.h"
#include "host/verbs/measure.h"
#include "host/verbs/stress_run.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

std::vector<StressFamily> families_for(const StressOptions& options) {
    return chosen_families(all_stress_families(), options.cases, options.except, options.quick);
}

}  // namespace

StressResult measure_stress(const StressOptions& options) {
    return run_stress_cases(families_for(options), options);
}

int run_stress(const StressOptions& options) {
    const std::vector<StressFamily> families = families_for(options);
    if (options.list) {
        print_result(stress_list(families));
        return 0;
    }
    check_result_path(options.json, json_start("mirrorball-stress"));
    if (!options.output.empty()) {
        create_output_folder(options.output);
        check_output_path(options.output + "/reference.png");
    }
    const StressResult result = measure_stress(options);
    if (options.json != "-") print_result(stress_text(result, options.verbose));
    write_result(options.json, options.json.empty() ? "" : stress_json(result));
    if (result.interrupted) return 128 + stop_flag();
    return static_cast<int>(result.passed() ? ExitCode::done : ExitCode::different);
}

}  // namespace rt
