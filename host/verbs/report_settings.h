// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/options/options.h"
#include "host/scene/scene.h"

namespace rt {

/// The bench options for the report's timings: five sizes up to the scene's own, plain and
/// anti-aliased, in float. --quick: two sizes.
BenchOptions bench_settings(const ReportOptions& options, const std::string& path,
                            const Scene& scene);

/// The report's sweep over sampling: coarser than converge's own, so that the whole page takes
/// minutes.
ConvergeOptions converge_settings(const ReportOptions& options, const std::string& path,
                                  const Scene& scene);

/// The commands that reproduce the page and its parts.
std::vector<std::string> report_commands(const ReportOptions& options);

}  // namespace rt
