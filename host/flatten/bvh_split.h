// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "host/flatten/bvh.h"
#include "host/flatten/bvh_range.h"

namespace rt::bvh {

/// The outcome for a range: a leaf, or two adjacent ranges.
template <typename T>
struct Halves {
    bool is_leaf = true;
    std::array<Range<T>, 2> sides;
};

/// All boxes, at depth 0.
template <typename T>
Range<T> whole_range(std::span<const BvhBox<T>> boxes, int threads);

/// Chooses what a range becomes, and reorders its boxes to match. A leaf holds at most
/// settings.most_in_leaf, and none lies deeper than max_bvh_depth. Uses `threads` threads, not
/// settings.threads; the outcome depends on neither.
template <typename T>
Halves<T> split_range(std::span<BvhBox<T>> boxes, const Range<T>& range,
                      const BvhSettings& settings, int threads);

}  // namespace rt::bvh
