// SPDX-License-Identifier: Apache-2.0
#include "host/options/aov.h"

#include <algorithm>
#include <array>
#include <string>

#include "host/error.h"
#include "host/image/output_path.h"
#include "host/options/command_line.h"
#include "host/options/lists.h"
#include "host/options/render_options.h"

namespace rt {

namespace {

constexpr std::array all_aovs{Aov::depth, Aov::normal, Aov::id, Aov::rays, Aov::samples};

Aov parse_aov(const std::string& name) {
    for (const Aov aov : all_aovs) {
        if (name == to_string(aov)) return aov;
    }
    std::vector<std::string> names;
    for (const Aov aov : all_aovs) names.emplace_back(to_string(aov));
    refuse_choice("--aov", name, names);
}

}  // namespace

const char* to_string(Aov aov) {
    constexpr std::array names{"depth", "normal", "id", "rays", "samples"};
    return names.at(static_cast<std::size_t>(aov));
}

void add_aov(const CommandLine& verb, std::vector<Aov>& aovs) {
    verb.option("--aov", "LIST",
                "also save per-pixel data: depth, normal, id, rays, samples; with an .exr as "
                "channels of NAME.aov.exr, otherwise in false colors as NAME.depth.png, ...",
                [&](const std::string& text) {
                    for (const std::string& name : split_list("--aov", text)) {
                        const Aov aov = parse_aov(name);
                        if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) {
                            aovs.push_back(aov);
                        }
                    }
                });
}

void settle_aovs(const RenderOptions& render) {
    if (render.aovs.empty()) return;
    if (render.is_batch() || render.shares) {
        throw Error(ExitCode::usage, "--aov is for one whole picture");
    }
    if (render.output.empty() || render.output == stdout_path) {
        throw Error(ExitCode::usage, "--aov names its files after the picture's: give -o FILE");
    }
}

}  // namespace rt
