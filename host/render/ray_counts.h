// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/record/describe.h"

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

template <typename A, Of<RayCounts> X>
void describe(A& a, X& x) {
    a("primary", x.primary, "eye rays");
    a("shadow", x.shadow, "towards lights");
    a("mirror", x.mirror, "reflected");
    a("transmitted", x.transmitted, "refracted");
    a("total", x.total(), "");
}

}  // namespace rt
