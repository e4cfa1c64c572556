// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rt {

/// "%d" or "%04d" in the name of an output, to be replaced by a frame's number, unless a letter or
/// digit follows.
struct FrameNumber {
    std::size_t at = 0, length = 0;  ///< where it stands in the name
    int digits = 1;                  ///< at least; padded with zeros
};

/// Empty if the name has none, or several.
std::optional<FrameNumber> find_frame_number(const std::string& name);

/// The pattern with each %s, unless a letter or digit follows, replaced by the scene's name,
/// without folder and extension.
std::string batch_output(const std::string& pattern, const std::string& scene);

}  // namespace rt
