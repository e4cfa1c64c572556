// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "host/flatten/bvh.h"

namespace rt {

template <typename T>
BvhShape shape_of(std::span<const typename Flat<T>::BvhNode> nodes, typename Flat<T>::Index root,
                  const BvhSettings& settings) {
    struct Entry {
        std::size_t node;
        int depth;
    };
    const auto area = [](const typename Flat<T>::BvhNode& node) {
        const double x = double(node.high.x) - node.low.x, y = double(node.high.y) - node.low.y;
        const double z = double(node.high.z) - node.low.z;
        return x * (y + z) + y * z;
    };
    BvhShape shape;
    const double whole = area(nodes[static_cast<std::size_t>(root)]);
    for (std::vector<Entry> stack{{static_cast<std::size_t>(root), 0}}; !stack.empty();) {
        const Entry entry = stack.back();
        stack.pop_back();
        const auto& node = nodes[entry.node];
        const double share = whole > 0 ? area(node) / whole : 1;
        shape.nodes += 1;
        if (node.count > 0) {
            shape.leaves += 1;
            shape.sah_cost += share * static_cast<double>(node.count);
            continue;
        }
        shape.depth = std::max(shape.depth, entry.depth + 1);
        shape.sah_cost += share * settings.inner_cost;
        const auto pair = static_cast<std::size_t>(node.first);
        stack.push_back({pair, entry.depth + 1});
        stack.push_back({pair + 1, entry.depth + 1});
    }
    return shape;
}

template BvhShape shape_of<float>(std::span<const f32::BvhNode>, f32::Index, const BvhSettings&);
template BvhShape shape_of<double>(std::span<const f64::BvhNode>, f64::Index, const BvhSettings&);

}  // namespace rt
