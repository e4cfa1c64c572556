// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "host/flatten/bvh_bins.h"

namespace rt::bvh {

/// The outcome of a partition: boxes that go left come first.
template <typename T>
struct Partition {
    std::size_t left_count = 0;
    std::array<Bounds<T>, 2> centers{Bounds<T>::none(), Bounds<T>::none()};  ///< left and right
};

/// Moves the boxes that go left to the front, in place, with `threads` threads; the resulting order
/// does not depend on how many.
template <typename T>
Partition<T> partition(std::span<BvhBox<T>> boxes, const Binning<T>& binning, const Split<T>& split,
                       int threads);

}  // namespace rt::bvh
