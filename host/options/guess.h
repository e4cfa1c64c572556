// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// What a mistyped word may have meant: "; did you mean '--size'?", or "" if nothing is close.
std::string guess_text(const std::string& word, const std::vector<std::string>& known);

}  // namespace rt
