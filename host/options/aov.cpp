// SPDX-License-Identifier: Apache-2.0
#include "host/options/aov.h"

#include <algorithm>
#include <string>

#include "host/base/error.h"
#include "host/image/output_path.h"
#include "host/options/command_line.h"
#include "host/options/parse.h"
#include "host/options/render_options.h"

namespace rt {

void add_aov(const CommandLine& verb, std::vector<Aov>& aovs) {
    verb.option("--aov", "LIST",
                "also save per-pixel data (depth, normal, id, rays, samples): next to an .exr "
                "picture as channels of NAME.aov.exr, otherwise as false-color pictures "
                "NAME.depth.png, ...",
                [&](const std::string& text) {
                    for (const Aov aov : list_of(one_of(aov_names))(text)) {
                        if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) {
                            aovs.push_back(aov);
                        }
                    }
                });
}

void settle_aovs(const RenderOptions& render) {
    if (render.aovs.empty()) return;
    if (render.is_batch() || render.shares) {
        usage_error("--aov works only for a single, whole picture");
    }
    if (render.output.empty() || render.output == stdout_path) {
        usage_error("--aov requires -o FILE, from which it derives its file names");
    }
}

}  // namespace rt
