// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "host/flatten/bvh.h"
#include "host/flatten/bvh_range.h"

namespace rt::bvh {

inline constexpr int bin_count = 16;
inline constexpr std::size_t binning_run = 1 << 16;  ///< boxes that a thread goes through at once

/// Which bin a center (times two) falls into, on each axis.
template <typename T>
struct Binning {
    Vector<T> low, scale;

    explicit Binning(const Bounds<T>& centers) : low(centers.low) {
        const T almost = T(bin_count) * (T(1) - 4 * Flat<T>::roundoff);
        for (int axis = 0; axis < 4; ++axis) {
            const T extent = axis < 3 ? centers.high[axis] - low[axis] : T(0);
            const T wanted = extent > 0 ? almost / extent : T(0);
            scale[axis] = std::isfinite(wanted) ? wanted : T(0);
        }
    }
    typename Lanes<T>::Mask all(const Vector<T>& center) const {
        return __builtin_convertvector((center - low) * scale, typename Lanes<T>::Mask);
    }
    int one(const Vector<T>& center, int axis) const {
        return static_cast<int>((center[axis] - low[axis]) * scale[axis]);
    }
};

/// The boxes in bins up to `bin` on `axis` go left; -1 where no split puts boxes on both sides.
template <typename T>
struct Split {
    int axis = -1, bin = 0;
    T cost = std::numeric_limits<T>::infinity();  ///< area times count, of both sides
};

/// The split of least cost. Lengths are multiplied by `scale` before areas are made of them.
template <typename T>
Split<T> best_split(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, T scale,
                    int threads);

}  // namespace rt::bvh
