// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rt {

/// "%d" or "%04d" in the name of an output, in which a frame's number takes its place.
struct FrameNumber {
    std::size_t at = 0, length = 0;  ///< of the characters that stand for it
    int digits = 1;                  ///< at least; zeros in front
};

/// Nothing where the name has none, or several.
std::optional<FrameNumber> find_frame_number(const std::string& name);

}  // namespace rt
