// SPDX-License-Identifier: Apache-2.0
#include "host/options/options.h"

#include <fmt/format.h>

#include "host/base/version.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

Options parse_options(int argc, const char* const* argv) {
    Options options;
    const CommandLineTexts texts{
        "mirrorball", "a headless OpenCL ray tracer that measures its own speed and error",
        fmt::format("mirrorball {} ({})", version, git_revision)};
    const auto describe = [&options](const CommandLine& program) {
        add_render(program, options);
        add_merge(program, options);
        add_compare(program, options);
        add_bench(program, options);
        add_converge(program, options);
        add_stress(program, options);
        add_report(program, options);
        add_devices(program, options);
        add_doctor(program, options);
        add_explain(program, options);
        add_scene(program, options);
    };
    options.worker_link = environment("MIRRORBALL_WORKER");
    if (!options.worker_link.empty()) options.render.rank_share = environment("MIRRORBALL_SHARE");
    options.render.command.assign(argv, argv + argc);
    options.render.drivers = options.devices.drivers = options.doctor.drivers = icd_place();
    options.text = read_command_line(texts, describe, argc, argv);
    return options;
}

}  // namespace rt
