// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rt {

/// Rays traced, by kind.
struct RayCounts {
    std::uint64_t primary = 0, shadow = 0, mirror = 0, transmitted = 0;

    std::uint64_t total() const { return primary + shadow + mirror + transmitted; }
    RayCounts& operator+=(const RayCounts& other) {
        primary += other.primary;
        shadow += other.shadow;
        mirror += other.mirror;
        transmitted += other.transmitted;
        return *this;
    }
};

}  // namespace rt
