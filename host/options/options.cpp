// SPDX-License-Identifier: Apache-2.0
#include "host/options/options.h"

#include <fmt/format.h>

#include "host/error.h"
#include "host/options/verb_options.h"
#include "host/version.h"

namespace rt {

namespace {

/// The arguments in CLI11's order, last first. A bare --stats takes no value: the word after it may
/// be the scene.
std::vector<std::string> reversed_arguments(int argc, const char* const* argv) {
    std::vector<std::string> arguments;
    for (int i = argc - 1; i > 0; --i) {
        const std::string argument = argv[i];
        arguments.push_back(argument == "--stats" ? "--stats=text" : argument);
    }
    return arguments;
}

/// An unknown verb is named; CLI11 only says that one is missing.
void check_verb(const CLI::App& app, const std::vector<std::string>& reversed) {
    if (reversed.empty() || reversed.back().starts_with("-")) return;
    std::string verbs;
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (verb->get_name() == reversed.back()) return;
        verbs += " " + verb->get_name();
    }
    throw Error(ExitCode::usage,
                fmt::format("unknown verb '{}'; there is:{}", reversed.back(), verbs));
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
    Options options;
    CLI::App app("a headless OpenCL ray tracer that tells the truth about itself", "mirrorball");
    app.set_version_flag("--version", fmt::format("mirrorball {} ({})", version, git_revision));
    app.require_subcommand(1);
    add_render(app, options);
    add_compare(app, options);
    add_bench(app, options);
    add_converge(app, options);
    add_stress(app, options);
    add_report(app, options);
    add_devices(app, options);
    add_scene(app, options);
    try {
        std::vector<std::string> arguments = reversed_arguments(argc, argv);
        check_verb(app, arguments);
        app.parse(std::move(arguments));
    } catch (const CLI::CallForHelp&) {
        options.text = app.help();
    } catch (const CLI::CallForAllHelp&) {
        options.text = app.help("", CLI::AppFormatMode::All);
    } catch (const CLI::CallForVersion&) {
        options.text = app.version() + "\n";
    } catch (const CLI::ParseError& error) {
        throw Error(
            ExitCode::usage,
            fmt::format("{}; see 'mirrorball --help' or 'mirrorball VERB --help'", error.what()));
    }
    return options;
}

}  // namespace rt
