// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rt {

/// A name from a file of unknown encoding as text that reports can print: where it is not UTF-8,
/// or holds control characters, those bytes become "\xNN".
std::string model_name(std::string_view bytes);

}  // namespace rt
