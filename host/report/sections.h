// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "host/report/report_data.h"

namespace rt {

// The page's sections about one scene, as HTML; ids and sources carry the scene's index.

/// The key numbers: the fastest device, its rays, its speed-up and its accuracy.
std::string glance_html(const ReportScene& scene, std::size_t index);

/// The pictures, their error maps, and plain and anti-aliased crops side by side.
std::string pictures_section(const ReportScene& scene, std::size_t index);

/// The paper's tables, every figure of every row, phases, size and threads.
std::string timing_section(const ReportScene& scene, std::size_t index);

/// Error against run time.
std::string error_time_section(const ReportScene& scene, std::size_t index);

/// Features used and left out, and what leaving them out saved.
std::string features_section(const ReportScene& scene, std::size_t index);

/// Verdicts of the stress suite, and error against the parameter of its families.
std::string stress_section(const StressResult& result);

/// The worst pictures of the families with the least margin, with their references and differences;
/// empty if there are none.
std::string stress_pictures(const StressResult& result);

/// The machine, the program and its devices, as a table.
std::string environment_section(const Report& report);

}  // namespace rt
