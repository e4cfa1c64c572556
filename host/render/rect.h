// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rt {

/// A rectangle of picture pixels; rows counted from the top.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;

    std::int64_t pixels() const { return std::int64_t{width} * height; }
    bool operator==(const Rect&) const = default;
};

}  // namespace rt
