// SPDX-License-Identifier: Apache-2.0
//
// Binned surface-area heuristic (Wald 2007): the boxes' centers fall into bins along each axis, and
// the plane between two bins with the lowest expected cost splits the node; the last few boxes are
// sorted instead. Large nodes are split level by level, all threads on one node or a node each;
// below a size that depends on the number of boxes alone, each subtree is one thread's work.
// Minima, maxima and counts are exact in any order, and boxes are moved in runs of one length, so
// the outcome does not depend on the number of threads.
//
// Where the heuristic sees nothing to gain (coincident centers), or would go too deep, a node is
// halved by number instead: that bounds the depth.
//
// This file assigns nodes to threads; bvh_split splits a node.
#include "host/flatten/bvh.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "host/base/parallel.h"
#include "host/flatten/bvh_split.h"

namespace rt {

namespace {

/// A subtree with fewer boxes than this is always one thread's work.
constexpr std::size_t smallest_task = 1 << 12;

template <typename T>
typename Flat<T>::Packed3 packed(const bvh::Vector<T>& v) {
    return {v[0], v[1], v[2]};
}

template <typename T>
class Builder {
   public:
    using Node = typename Flat<T>::BvhNode;
    using Index = typename Flat<T>::Index;

    Builder(std::span<BvhBox<T>> boxes, int threads) : boxes_(boxes), threads_(threads) {}

    Index build(HugeVector<Node>& nodes) {
        if (nodes.size() % 2 == 0) nodes.push_back({});
        const std::size_t root = nodes.size();
        nodes.push_back({});
        split_large({{bvh::whole_range<T>(boxes_, threads_), root}}, nodes);
        finish_tasks(nodes);
        return static_cast<Index>(root);
    }

   private:
    /// A range and the node assigned to it.
    struct Task {
        bvh::Range<T> range;
        std::size_t node;
    };

    /// Splits what is too large for one thread, level by level: the largest ranges one by one, each
    /// with all threads, the others in parallel.
    void split_large(std::vector<Task> level, HugeVector<Node>& nodes) {
        const std::size_t task_size = std::max(smallest_task, boxes_.size() / 64);
        const auto threads = static_cast<std::size_t>(threads_);
        while (!level.empty()) {
            std::vector<bvh::Halves<T>> halves(level.size());
            const auto split = [&](std::size_t i, int on_it) {
                halves[i] = bvh::split_range<T>(boxes_, level[i].range, on_it);
            };
            const auto is_shared = [&](std::size_t i) {
                return 2 * threads * level[i].range.count() > boxes_.size();
            };
            const auto is_task = [&](std::size_t i) { return level[i].range.count() <= task_size; };
            for (std::size_t i = 0; i < level.size(); ++i) {
                if (is_shared(i) && !is_task(i)) split(i, threads_);
            }
            for_each_run(level.size(), 1, threads_, [&](std::size_t i, std::size_t) {
                if (!is_shared(i) && !is_task(i)) split(i, 1);
            });
            std::vector<Task> next;
            for (std::size_t i = 0; i < level.size(); ++i) {
                if (halves[i].is_leaf) {
                    tasks_.push_back(level[i]);
                    continue;
                }
                set_inner(nodes[level[i].node], level[i].range, nodes.size());
                for (const bvh::Range<T>& side : halves[i].sides) {
                    next.push_back({side, nodes.size()});
                    nodes.push_back({});
                }
            }
            level = std::move(next);
        }
    }

    /// A subtree under construction: its root is node 1, children in pairs from 2 on, as in
    /// `nodes`.
    struct Subtree {
        std::span<Node> nodes;
        std::size_t size = 2;
    };

    /// Builds the subtrees in parallel in one block, each in the space reserved for its boxes, and
    /// appends them. One block, since memory that many threads allocate and free stays with them.
    void finish_tasks(HugeVector<Node>& nodes) {
        const auto block = std::make_unique_for_overwrite<Node[]>(2 * boxes_.size());
        std::vector<Subtree> subtrees;
        for (const Task& task : tasks_) {
            subtrees.push_back({{&block[2 * task.range.first], 2 * task.range.count()}});
        }
        for_each_run(tasks_.size(), 1, threads_, [&](std::size_t i, std::size_t) {
            build_subtree(tasks_[i].range, 1, subtrees[i]);
        });
        std::vector<std::size_t> starts;
        std::size_t size = nodes.size();
        for (const Subtree& subtree : subtrees) {
            starts.push_back(size);
            size += subtree.size - 2;
        }
        nodes.resize(size);
        for_each_run(tasks_.size(), 1, threads_, [&](std::size_t i, std::size_t) {
            const auto moved = [&](Node node) {
                if (node.count == 0) node.first += static_cast<Index>(starts[i]) - 2;
                return node;
            };
            const std::span<const Node> built = subtrees[i].nodes.first(subtrees[i].size);
            nodes[tasks_[i].node] = moved(built[1]);
            std::transform(built.begin() + 2, built.end(),
                           nodes.begin() + static_cast<std::ptrdiff_t>(starts[i]), moved);
        });
    }

    void build_subtree(const bvh::Range<T>& range, std::size_t node, Subtree& subtree) {
        const bvh::Halves<T> halves = bvh::split_range<T>(boxes_, range, 1);
        if (halves.is_leaf) {
            subtree.nodes[node] = {packed<T>(range.bounds.low), static_cast<Index>(range.first),
                                   packed<T>(range.bounds.high), static_cast<Index>(range.count())};
            return;
        }
        const std::size_t pair = subtree.size;
        set_inner(subtree.nodes[node], range, pair);
        subtree.size += 2;
        build_subtree(halves.sides[0], pair, subtree);
        build_subtree(halves.sides[1], pair + 1, subtree);
    }

    static void set_inner(Node& node, const bvh::Range<T>& range, std::size_t pair) {
        node = {packed<T>(range.bounds.low), static_cast<Index>(pair), packed<T>(range.bounds.high),
                0};
    }

    const std::span<BvhBox<T>> boxes_;
    const int threads_;
    std::vector<Task> tasks_;
};

}  // namespace

template <typename T>
typename Flat<T>::Index build_bvh(std::span<BvhBox<T>> boxes, int threads,
                                  HugeVector<typename Flat<T>::BvhNode>& nodes) {
    return Builder<T>(boxes, threads).build(nodes);
}

template f32::Index build_bvh<float>(std::span<f32::BvhNode>, int, HugeVector<f32::BvhNode>&);
template f64::Index build_bvh<double>(std::span<f64::BvhNode>, int, HugeVector<f64::BvhNode>&);

template <typename T>
BvhShape shape_of(std::span<const typename Flat<T>::BvhNode> nodes, typename Flat<T>::Index root) {
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
        shape.sah_cost += share * bvh_inner_cost;
        const auto pair = static_cast<std::size_t>(node.first) - start;
        depths[pair] = depths[pair + 1] = static_cast<std::uint8_t>(depth + 1);
    }
    return shape;
}

template BvhShape shape_of<float>(std::span<const f32::BvhNode>, f32::Index);
template BvhShape shape_of<double>(std::span<const f64::BvhNode>, f64::Index);

}  // namespace rt
