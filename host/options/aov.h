// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace rt {

class CommandLine;
struct RenderOptions;

/// What render --aov saves for each pixel besides its color.
enum class Aov { depth, normal, id, rays, samples };

const char* to_string(Aov aov);

void add_aov(const CommandLine& verb, std::vector<Aov>& aovs);

/// Throws Error (ExitCode::usage) if there is no file to put them beside.
void settle_aovs(const RenderOptions& render);

}  // namespace rt
