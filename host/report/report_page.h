// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/report/report_data.h"

namespace rt {

/// The report as one HTML page that needs nothing else: pictures, plots, style and the raw data of
/// every figure are in it, and no script runs.
std::string report_page(const Report& report);

}  // namespace rt
