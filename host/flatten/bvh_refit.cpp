// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "host/base/parallel.h"
#include "host/flatten/bvh.h"
#include "host/flatten/bvh_range.h"

namespace rt {

namespace {

template <typename T>
void enclose(std::span<const typename Flat<T>::BvhNode> inside, typename Flat<T>::BvhNode& node) {
    bvh::Bounds<T> bounds = bvh::Bounds<T>::none();
    for (const auto& box : inside) bounds.add(bvh::bounds_of<T>(box));
    node.low = {bounds.low[0], bounds.low[1], bounds.low[2]};
    node.high = {bounds.high[0], bounds.high[1], bounds.high[2]};
}

}  // namespace

template <typename T>
void refit_bvh(std::span<const BvhBox<T>> boxes, typename Flat<T>::Index root, int threads,
               std::span<typename Flat<T>::BvhNode> nodes) {
    const auto below = nodes.subspan(static_cast<std::size_t>(root));
    constexpr std::size_t run_length = 1 << 13;
    for_each_run(below.size(), run_length, threads, [&](std::size_t first, std::size_t last) {
        for (auto& node : below.subspan(first, last - first)) {
            const auto count = static_cast<std::size_t>(node.count);
            if (count == 0) continue;
            enclose<T>(boxes.subspan(static_cast<std::size_t>(node.first), count), node);
        }
    });
    for (std::size_t i = below.size(); i-- > 0;) {  // children come after their parents
        auto& node = below[i];
        if (node.count > 0) continue;
        enclose<T>(nodes.subspan(static_cast<std::size_t>(node.first), 2), node);
    }
}

template void refit_bvh<float>(std::span<const f32::BvhNode>, f32::Index, int,
                               std::span<f32::BvhNode>);
template void refit_bvh<double>(std::span<const f64::BvhNode>, f64::Index, int,
                                std::span<f64::BvhNode>);

}  // namespace rt
