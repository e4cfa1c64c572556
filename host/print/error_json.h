// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/image/image_error.h"

namespace rt {

/// "error" in every result (docs/results-format.md).
nlohmann::ordered_json error_json(const ImageError& error);

}  // namespace rt
