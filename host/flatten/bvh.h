// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "host/base/memory.h"
#include "host/flatten/flat_types.h"

namespace rt {

/// The box of one primitive: a leaf that holds only primitive `first`.
template <typename T>
using BvhBox = typename Flat<T>::BvhNode;

/// What a ray's visit to an inner node costs, in tests of primitives.
inline constexpr int bvh_inner_cost = 3;

inline constexpr std::size_t most_in_leaf = 8;  ///< primitives

/// The most inner nodes on a path from the root to a leaf. A traversal's stack holds at most one
/// node for each inner node above it, and its end.
inline constexpr int max_bvh_depth = f32::RT_BVH_STACK - 2;

/// Properties of a finished hierarchy.
struct BvhShape {
    std::size_t nodes = 0, leaves = 0;
    int depth = 0;        ///< inner nodes on the longest path
    double sah_cost = 0;  ///< expected tests of a ray that hits the root
};

/// Builds a hierarchy over the boxes (at least one) by the surface-area heuristic, appends its
/// nodes to `nodes` and returns the index of its root (odd). Reorders the boxes to match the
/// leaves, whose `first` counts them from 0. At most max_bvh_depth deep for any finite boxes. Does
/// not depend on the number of threads.
template <typename T>
typename Flat<T>::Index build_bvh(std::span<BvhBox<T>> boxes, int threads,
                                  HugeVector<typename Flat<T>::BvhNode>& nodes);

/// Measures the last hierarchy in `nodes`, whose root is given.
template <typename T>
BvhShape shape_of(std::span<const typename Flat<T>::BvhNode> nodes, typename Flat<T>::Index root);

}  // namespace rt
