// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace rt {

/// Bytes as text, four characters for three (RFC 4648, section 4).
std::string base64(std::span<const std::byte> bytes);

}  // namespace rt
