// SPDX-License-Identifier: Apache-2.0
#include "host/options/verb_options.h"

namespace rt {

void add_devices(CLI::App& app, Options& options) {
    CLI::App& verb =
        *app.add_subcommand("devices", "what can render here, and why something cannot");
    verb.add_flag("--json", options.devices.json, "as JSON on stdout");
    verb.callback([&] { options.verb = Verb::devices; });
}

}  // namespace rt
