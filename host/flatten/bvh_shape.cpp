// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/flatten/bvh.h"

namespace rt {

template <typename T>
BvhShape shape_of(std::span<const typename Flat<T>::BvhNode> nodes, typename Flat<T>::Index root,
                  const BvhSettings& settings) {
    const auto area = [](const typename Flat<T>::BvhNode& node) {
        const double x = double(node.high.x) - node.low.x, y = double(node.high.y) - node.low.y;
        const double z = double(node.high.z) - node.low.z;
        return x * (y + z) + y * z;
    };
    const auto start = static_cast<std::size_t>(root);
    const double whole = area(nodes[start]);
    BvhShape shape;
    std::vector<std::uint8_t> depths(nodes.size() - start);  // plus one; 0: not in this hierarchy
    depths[0] = 1;
    for (std::size_t i = start; i < nodes.size(); ++i) {
        const std::uint8_t depth = depths[i - start];
        if (depth == 0) continue;
        const auto& node = nodes[i];
        const double share = whole > 0 ? area(node) / whole : 1;
        shape.nodes += 1;
        if (node.count > 0) {
            shape.leaves += 1;
            shape.sah_cost += share * static_cast<double>(node.count);
            continue;
        }
        shape.depth = std::max<int>(shape.depth, depth);
        shape.sah_cost += share * settings.inner_cost;
        const auto pair = static_cast<std::size_t>(node.first) - start;
        depths[pair] = depths[pair + 1] = static_cast<std::uint8_t>(depth + 1);
    }
    return shape;
}

template BvhShape shape_of<float>(std::span<const f32::BvhNode>, f32::Index, const BvhSettings&);
template BvhShape shape_of<double>(std::span<const f64::BvhNode>, f64::Index, const BvhSettings&);

}  // namespace rt
