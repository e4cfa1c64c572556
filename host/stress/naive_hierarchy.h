// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "host/flatten/bvh.h"

namespace rt {

/// A textbook BVH: plain slab tests, no margins; boxes fit the triangles' corners exactly.
template <typename T>
class NaiveHierarchy {
   public:
    using Corners = std::array<Vec3<T>, 3>;

    /// Builds over these triangles; `order` becomes their indices in leaf order.
    NaiveHierarchy(std::span<const Corners> triangles, std::vector<std::size_t>& order) {
        std::vector<BvhBox<T>> boxes;
        for (const Corners& corners : triangles) {
            BvhBox<T> box = box_of_corners(corners);
            box.first = static_cast<Index>(boxes.size());
            box.count = 1;
            boxes.push_back(box);
        }
        root_ = build_bvh<T>(boxes, {}, nodes_);
        order.clear();
        for (const BvhBox<T>& box : boxes) order.push_back(static_cast<std::size_t>(box.first));
    }

    /// Calls visit(index in leaf order) for the triangles of each leaf that the ray enters before
    /// `limit`, nearer leaves first, until a call returns true. Returns whether one did.
    template <typename Visit>
    bool visit(const Vec3<T>& origin, const Vec3<T>& dir, const T& limit,
               const Visit& visit) const {
        const Vec3<T> inverse = T(1) / dir;
        std::array<T, f32::RT_BVH_STACK> nears;
        std::array<Index, f32::RT_BVH_STACK> places;
        std::size_t size = 0;
        Index place = root_;
        T near = enter(nodes_[at(root_)], origin, inverse);
        for (;;) {
            while (!(near < limit)) {
                if (size == 0) return false;
                near = nears[--size];
                place = places[size];
            }
            const Node& node = nodes_[at(place)];
            if (node.count > 0) {
                for (Index i = node.first; i < node.first + node.count; ++i) {
                    if (visit(at(i))) return true;
                }
                near = std::numeric_limits<T>::infinity();
                continue;
            }
            const T first = enter(nodes_[at(node.first)], origin, inverse);
            const T second = enter(nodes_[at(node.first + 1)], origin, inverse);
            const Index swapped = second < first ? 1 : 0;
            const T farther = swapped ? first : second;
            if (farther < limit) {
                nears[size] = farther;
                places[size++] = node.first + 1 - swapped;
            }
            near = swapped ? second : first;
            place = node.first + swapped;
        }
    }

   private:
    using Node = typename Flat<T>::BvhNode;
    using Index = typename Flat<T>::Index;

    static std::size_t at(Index index) { return static_cast<std::size_t>(index); }

    static BvhBox<T> box_of_corners(const Corners& corners) {
        BvhBox<T> box{};
        const auto [x, y, z] =
            std::array{span_of(corners, 0), span_of(corners, 1), span_of(corners, 2)};
        box.low = {x.first, y.first, z.first};
        box.high = {x.second, y.second, z.second};
        return box;
    }

    static std::pair<T, T> span_of(const Corners& corners, int axis) {
        return std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    }

    /// Distance at which the ray enters the node's box; infinite for a miss.
    static T enter(const Node& node, const Vec3<T>& origin, const Vec3<T>& inverse) {
        T near = 0, far = std::numeric_limits<T>::infinity();
        clip(node.low.x, node.high.x, origin.x, inverse.x, near, far);
        clip(node.low.y, node.high.y, origin.y, inverse.y, near, far);
        clip(node.low.z, node.high.z, origin.z, inverse.z, near, far);
        return near <= far ? near : std::numeric_limits<T>::infinity();
    }

    static void clip(T low, T high, T origin, T inverse, T& near, T& far) {
        const T to_low = (low - origin) * inverse, to_high = (high - origin) * inverse;
        near = std::max(near, std::min(to_low, to_high));
        far = std::min(far, std::max(to_low, to_high));
    }

    HugeVector<Node> nodes_;
    Index root_ = 0;
};

}  // namespace rt
