// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/report/report_data.h"

namespace rt {

/// The report as one self-contained HTML page: it includes pictures, plots, style and the raw data
/// of every figure, and runs no scripts.
std::string report_page(const Report& report);

}  // namespace rt
