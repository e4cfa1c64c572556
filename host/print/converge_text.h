// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/converge_result.h"

namespace rt {

/// Human-readable tables, at most 100 columns wide.
std::string converge_text(const ConvergeResult& result);

}  // namespace rt
