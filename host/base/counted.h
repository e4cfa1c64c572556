// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string>

namespace rt {

/// "1 sphere", "0 lights"; with a plural of its own, "1 pixel is", "2 pixels are".
template <std::integral N>
std::string counted(N count, const std::string& noun, const std::string& plural = "") {
    return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

}  // namespace rt
