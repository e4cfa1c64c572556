// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/converge_result.h"

namespace rt {

/// The tables for people, at most 100 columns wide.
std::string converge_text(const ConvergeResult& result);

}  // namespace rt
