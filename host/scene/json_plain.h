// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "host/scene/json_document.h"

namespace rt {

/// Parses common JSON, four times as fast as parse_json_carefully; empty on any error, repeated
/// key, or valid but rare construct (an escape, a number that underflows). The text must be valid
/// UTF-8.
std::optional<JsonValue> parse_plain_json(std::string_view text);

}  // namespace rt
