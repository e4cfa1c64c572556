// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "host/flatten/bvh.h"
#include "host/flatten/bvh_range.h"

namespace rt::bvh {

inline constexpr std::size_t most_bins = 16;
inline constexpr std::size_t run_length = 1 << 14;  ///< boxes that a thread processes at a time

/// Which of `count` bins a center (times two) falls into, on each axis.
template <typename T>
struct Binning {
    Vector<T> low, scale;
    std::size_t count;

    Binning(const Bounds<T>& centers, std::size_t bins) : low(centers.low), count(bins) {
        const T almost = T(bins) * (T(1) - 4 * Flat<T>::roundoff);
        for (int axis = 0; axis < 4; ++axis) {
            const T extent = axis < 3 ? centers.high[axis] - low[axis] : T(0);
            const T wanted = extent > 0 ? almost / extent : T(0);
            scale[axis] = std::isfinite(wanted) ? wanted : T(0);
        }
    }
    Mask<T> all(const Vector<T>& center) const {
        return __builtin_convertvector((center - low) * scale, Mask<T>);
    }
    int one(T center, int axis) const {
        return static_cast<int>((center - low[axis]) * scale[axis]);
    }
};

/// The contents of each bin, on each axis.
template <typename T>
struct Bins {
    std::size_t count = 0;
    std::array<std::array<Bounds<T>, 3>, most_bins> bounds;
    std::array<Mask<T>, most_bins> boxes;  ///< how many
};

/// Bins the boxes with `threads` threads; the outcome does not depend on how many.
template <typename T>
void fill_bins(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, int threads,
               Bins<T>& bins);

/// The boxes in bins up to `bin` on `axis` go left; -1 if no split leaves boxes on both sides.
template <typename T>
struct Split {
    int axis = -1, bin = 0;
    T cost = std::numeric_limits<T>::infinity();  ///< area times count, of both sides
    std::array<Bounds<T>, 2> bounds{Bounds<T>::none(), Bounds<T>::none()};  ///< of the sides
};

/// The split of least cost. Lengths are multiplied by `scale` before areas are computed.
template <typename T>
Split<T> best_split(const Bins<T>& bins, T scale);

}  // namespace rt::bvh
