// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "host/scene/json_document.h"

namespace rt {

/// Reads the JSON texts that people and programs write nearly always, four times as fast as
/// parse_json's careful reading: nothing when anything is wrong, repeated, or unusual, be it right
/// (an escape, a number too small for a double). The text is valid UTF-8.
std::optional<JsonValue> parse_plain_json(std::string_view text);

}  // namespace rt
