// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/image/image_error.h"

namespace rt {

/// The table of `compare`: one line per figure of an image error between pictures with that many
/// pixels. If no pixel was finite in both, it says so instead.
std::string error_table(const ImageError& error, std::size_t pixels);

/// "error" in every result (docs/results-format.md).
nlohmann::ordered_json error_json(const ImageError& error);

}  // namespace rt
