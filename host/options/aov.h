// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/base/text.h"

namespace rt {

class CommandLine;
struct RenderOptions;

/// Per-pixel data that render --aov saves in addition to the color.
enum class Aov { depth, normal, id, rays, samples };

inline constexpr Named<Aov> aov_names[] = {{"depth", Aov::depth},
                                           {"normal", Aov::normal},
                                           {"id", Aov::id},
                                           {"rays", Aov::rays},
                                           {"samples", Aov::samples}};

inline const char* to_string(Aov aov) { return name_of(aov_names, aov); }

void add_aov(const CommandLine& verb, std::vector<Aov>& aovs);

/// Throws Error (ExitCode::usage) if there is no file to save them next to.
void settle_aovs(const RenderOptions& render);

}  // namespace rt
