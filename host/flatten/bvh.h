// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/flatten/flat_types.h"

namespace rt {

/// The box of one primitive: a node that holds that primitive, `first`, alone.
template <typename T>
using BvhBox = typename Flat<T>::BvhNode;

/// How to build. Costs are in units of testing one primitive.
struct BvhSettings {
    double inner_cost = 1.4;  ///< of a ray that visits an inner node
    int most_in_leaf = 8;     ///< at most this many primitives in a leaf
    int threads = 1;          ///< to build with; the hierarchy does not depend on it
};

/// Inner nodes from a root down to any leaf, at most. A traversal that puts both children on its
/// stack, the nearer on top, has one node more there than it has gone down.
inline constexpr int max_bvh_depth = f32::RT_BVH_STACK - 2;

/// How a hierarchy came out.
struct BvhShape {
    std::size_t nodes = 0, leaves = 0;
    int depth = 0;        ///< inner nodes on the longest way down
    double sah_cost = 0;  ///< expected tests of a ray that meets the root, after BvhSettings
};

/// Builds a hierarchy over the boxes, one or more of them, by the surface-area heuristic, appends
/// its nodes to `nodes` and returns the place of its root (odd). The boxes are put into the order
/// of the leaves, whose `first` counts them from 0. At most max_bvh_depth deep, whatever the boxes
/// are, as long as they are finite.
template <typename T>
typename Flat<T>::Index build_bvh(std::span<BvhBox<T>> boxes, const BvhSettings& settings,
                                  std::vector<typename Flat<T>::BvhNode>& nodes);

/// Looks over the hierarchy below a root.
template <typename T>
BvhShape shape_of(std::span<const typename Flat<T>::BvhNode> nodes, typename Flat<T>::Index root,
                  const BvhSettings& settings);

}  // namespace rt
