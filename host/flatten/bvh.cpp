// SPDX-License-Identifier: Apache-2.0
//
// Binned surface-area heuristic (Wald 2007): the boxes' centres fall into bins along each axis, and
// the plane between two bins with the lowest expected cost splits the node. Large nodes are split
// level by level, all threads on one node or a node each; below a size that depends on the number
// of boxes alone, each subtree is one thread's work. Minima, maxima and counts are exact in any
// order, so the outcome does not depend on the number of threads.
//
// Where the heuristic sees nothing to gain (coincident centres), or would dig too deep, a node is
// halved by number instead: that bounds the depth.
#include "host/flatten/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "host/parallel.h"

// Vectors wider than the build's instruction set are passed around, but only within this file.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace rt {

namespace {

constexpr int max_bins = 16;
constexpr std::size_t binning_run = 1 << 16;  ///< boxes that a thread bins at once
constexpr std::size_t smallest_task = 1 << 12;

/// Four numbers in one register; the fourth is 0.
template <typename T>
struct Lanes {
    typedef T Vector __attribute__((vector_size(4 * sizeof(T))));
    typedef typename Flat<T>::Index Mask __attribute__((vector_size(4 * sizeof(T))));
};
template <typename T>
using Vector = typename Lanes<T>::Vector;

template <typename T>
Vector<T> load(const typename Flat<T>::Packed3& row) {
    typename Lanes<T>::Mask bits;
    std::memcpy(&bits, &row, sizeof bits);
    bits &= typename Lanes<T>::Mask{-1, -1, -1, 0};
    Vector<T> v;
    std::memcpy(&v, &bits, sizeof v);
    return v;
}

template <typename T>
struct Bounds {
    Vector<T> low, high;

    static constexpr T huge = std::numeric_limits<T>::infinity();
    Bounds() : low{huge, huge, huge, huge}, high{-huge, -huge, -huge, -huge} {}

    void add(const Vector<T>& point_low, const Vector<T>& point_high) {
        low = point_low < low ? point_low : low;
        high = point_high > high ? point_high : high;
    }
    void add(const Bounds& other) { add(other.low, other.high); }

    /// Half the surface, in units of 1 / scale.
    T area(T scale) const {
        const Vector<T> d = (high - low) * scale;
        return d[0] * (d[1] + d[2]) + d[1] * d[2];
    }
};

/// Boxes first .. last with their bounds and those of their centres (times two).
template <typename T>
struct Range {
    std::size_t first = 0, last = 0;
    int depth = 0;
    Bounds<T> bounds, centers;

    std::size_t count() const { return last - first; }

    void add(const BvhBox<T>& box) {
        const Vector<T> box_low = load<T>(box.low), box_high = load<T>(box.high);
        bounds.add(box_low, box_high);
        centers.add(box_low + box_high, box_low + box_high);
    }
};

/// Which bin a centre (times two) falls into, on each axis.
template <typename T>
struct Binning {
    Vector<T> low, scale;
    int bins;

    Binning(const Bounds<T>& centers, int bin_count) : low(centers.low), bins(bin_count) {
        const T almost = T(bins) * (T(1) - 4 * Flat<T>::roundoff);
        for (int axis = 0; axis < 4; ++axis) {
            const T extent = axis < 3 ? centers.high[axis] - low[axis] : T(0);
            const T wanted = extent > 0 ? almost / extent : T(0);
            scale[axis] = std::isfinite(wanted) ? wanted : T(0);
        }
    }
    typename Lanes<T>::Mask all(const Vector<T>& center) const {
        return __builtin_convertvector((center - low) * scale, typename Lanes<T>::Mask);
    }
    int one(const Vector<T>& center, int axis) const {
        return static_cast<int>((center[axis] - low[axis]) * scale[axis]);
    }
};

template <typename T>
struct Bins {
    std::array<std::array<Bounds<T>, max_bins>, 3> bounds;
    std::array<std::array<std::size_t, max_bins>, 3> counts{};

    void add(const Bins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t bin = 0; bin < max_bins; ++bin) {
                bounds[axis][bin].add(other.bounds[axis][bin]);
                counts[axis][bin] += other.counts[axis][bin];
            }
        }
    }
};

/// The boxes in bins up to `bin` on `axis` go left; an axis of -1 halves them by number.
template <typename T>
struct Split {
    int axis = -1, bin = 0;
    T cost = std::numeric_limits<T>::infinity();  ///< area times count, of both sides
};

template <typename T>
Vector<T> center_of(const BvhBox<T>& box) {
    return load<T>(box.low) + load<T>(box.high);
}

template <typename T>
void fill_bins(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, Bins<T>& bins) {
    for (const BvhBox<T>& box : boxes) {
        const Vector<T> low = load<T>(box.low), high = load<T>(box.high);
        const auto bin = binning.all(low + high);
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis), b = static_cast<std::size_t>(bin[axis]);
            bins.bounds[a][b].add(low, high);
            bins.counts[a][b] += 1;
        }
    }
}

template <typename T>
Split<T> best_split(const Bins<T>& bins, int bin_count, T scale) {
    const auto count = static_cast<std::size_t>(bin_count);
    Split<T> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<T, max_bins> right_cost;
        Bounds<T> side;
        std::size_t on_side = 0;
        for (std::size_t bin = count - 1; bin > 0; --bin) {
            side.add(bins.bounds[axis][bin]);
            on_side += bins.counts[axis][bin];
            right_cost[bin] = on_side > 0 ? side.area(scale) * static_cast<T>(on_side)
                                          : std::numeric_limits<T>::infinity();
        }
        side = Bounds<T>();
        on_side = 0;
        for (std::size_t bin = 0; bin + 1 < count; ++bin) {
            side.add(bins.bounds[axis][bin]);
            on_side += bins.counts[axis][bin];
            if (on_side == 0) continue;
            const T cost = side.area(scale) * static_cast<T>(on_side) + right_cost[bin + 1];
            if (cost < best.cost) best = {static_cast<int>(axis), static_cast<int>(bin), cost};
        }
    }
    return best;
}

template <typename T>
typename Flat<T>::Packed3 packed(const Vector<T>& v) {
    return {v[0], v[1], v[2]};
}

template <typename T>
class Builder {
   public:
    using Node = typename Flat<T>::BvhNode;
    using Index = typename Flat<T>::Index;

    Builder(std::span<BvhBox<T>> boxes, const BvhSettings& settings)
        : boxes_(boxes), settings_(settings) {}

    Index build(std::vector<Node>& nodes) {
        if (nodes.size() % 2 == 0) nodes.emplace_back();
        const std::size_t root = nodes.size();
        nodes.emplace_back();
        split_large({{whole(), root}}, nodes);
        finish_tasks(nodes);
        return static_cast<Index>(root);
    }

   private:
    /// A range whose node is known.
    struct Task {
        Range<T> range;
        std::size_t node;
    };
    struct Halves {
        bool is_leaf = true;
        std::array<Range<T>, 2> sides;
    };

    Range<T> whole() const {
        const std::size_t count = boxes_.size();
        std::vector<Range<T>> parts((count + binning_run - 1) / binning_run);
        for_each_run(count, binning_run, settings_.threads,
                     [&](std::size_t first, std::size_t last) {
                         Range<T>& part = parts[first / binning_run];
                         for (std::size_t i = first; i < last; ++i) part.add(boxes_[i]);
                     });
        Range<T> range;
        range.last = count;
        for (const Range<T>& part : parts) {
            range.bounds.add(part.bounds);
            range.centers.add(part.centers);
        }
        return range;
    }

    /// Splits what is too large for one thread, level by level.
    void split_large(std::vector<Task> level, std::vector<Node>& nodes) {
        const std::size_t task_size = std::max(smallest_task, boxes_.size() / 64);
        const auto threads = static_cast<std::size_t>(settings_.threads);
        while (!level.empty()) {
            std::vector<Halves> halves(level.size());
            const int across = level.size() >= threads ? settings_.threads : 1;
            for_each_run(level.size(), 1, across, [&](std::size_t i, std::size_t) {
                if (level[i].range.count() <= task_size) return;
                halves[i] = split(level[i].range, across == 1 ? settings_.threads : 1);
            });
            std::vector<Task> next;
            for (std::size_t i = 0; i < level.size(); ++i) {
                if (halves[i].is_leaf) {
                    tasks_.push_back(level[i]);
                    continue;
                }
                set_inner(nodes[level[i].node], level[i].range, nodes.size());
                for (const Range<T>& side : halves[i].sides) {
                    next.push_back({side, nodes.size()});
                    nodes.emplace_back();
                }
            }
            level = std::move(next);
        }
    }

    /// Builds the subtrees, each in an array of its own, and appends these.
    void finish_tasks(std::vector<Node>& nodes) {
        std::vector<std::vector<Node>> subtrees(tasks_.size());
        for_each_run(tasks_.size(), 1, settings_.threads, [&](std::size_t i, std::size_t) {
            subtrees[i].reserve(tasks_[i].range.count());
            subtrees[i].resize(2);
            build_subtree(tasks_[i].range, 1, subtrees[i]);
        });
        std::vector<std::size_t> starts;
        std::size_t size = nodes.size();
        for (const auto& subtree : subtrees) {
            starts.push_back(size);
            size += subtree.size() - 2;
        }
        nodes.resize(size);
        for_each_run(tasks_.size(), 1, settings_.threads, [&](std::size_t i, std::size_t) {
            const auto moved = [&](Node node) {
                if (node.count == 0) node.first += static_cast<Index>(starts[i]) - 2;
                return node;
            };
            nodes[tasks_[i].node] = moved(subtrees[i][1]);
            std::transform(subtrees[i].begin() + 2, subtrees[i].end(),
                           nodes.begin() + static_cast<std::ptrdiff_t>(starts[i]), moved);
            std::vector<Node>().swap(subtrees[i]);
        });
    }

    void build_subtree(const Range<T>& range, std::size_t node, std::vector<Node>& nodes) {
        const Halves halves = split(range, 1);
        if (halves.is_leaf) {
            nodes[node] = {packed<T>(range.bounds.low), static_cast<Index>(range.first),
                           packed<T>(range.bounds.high), static_cast<Index>(range.count())};
            return;
        }
        const std::size_t pair = nodes.size();
        set_inner(nodes[node], range, pair);
        nodes.resize(pair + 2);
        build_subtree(halves.sides[0], pair, nodes);
        build_subtree(halves.sides[1], pair + 1, nodes);
    }

    static void set_inner(Node& node, const Range<T>& range, std::size_t pair) {
        node = {packed<T>(range.bounds.low), static_cast<Index>(pair), packed<T>(range.bounds.high),
                0};
    }

    Halves split(const Range<T>& range, int threads) {
        if (range.count() == 1) return {};
        const bool fits = range.count() <= static_cast<std::size_t>(settings_.most_in_leaf);
        const int halvings = std::bit_width(range.count());
        const bool too_deep = range.depth + halvings >= max_bvh_depth;
        const Vector<T> size = range.bounds.high - range.bounds.low;
        const T scale = T(1) / std::max({size[0], size[1], size[2]});
        if (too_deep || !std::isfinite(scale)) {
            return fits ? Halves{} : partition(range, Binning<T>(range.centers, 1), {});
        }
        const Binning<T> binning(range.centers, max_bins);
        const Split<T> best = best_split(binned(range, binning, threads), max_bins, scale);
        if (fits) {
            const T area = range.bounds.area(scale);
            const T inner = static_cast<T>(settings_.inner_cost) * area + best.cost;
            if (!(inner < area * static_cast<T>(range.count()))) return {};
        }
        return partition(range, binning, best);
    }

    Bins<T> binned(const Range<T>& range, const Binning<T>& binning, int threads) const {
        const std::span<const BvhBox<T>> boxes = boxes_.subspan(range.first, range.count());
        Bins<T> bins;
        if (threads == 1 || boxes.size() <= binning_run) {
            fill_bins<T>(boxes, binning, bins);
            return bins;
        }
        std::vector<Bins<T>> parts((boxes.size() + binning_run - 1) / binning_run);
        for_each_run(boxes.size(), binning_run, threads, [&](std::size_t first, std::size_t last) {
            fill_bins<T>(boxes.subspan(first, last - first), binning, parts[first / binning_run]);
        });
        for (const Bins<T>& part : parts) bins.add(part);
        return bins;
    }

    Halves partition(const Range<T>& range, const Binning<T>& binning, const Split<T>& best) {
        Halves halves;
        halves.is_leaf = false;
        Range<T>& left = halves.sides[0];
        Range<T>& right = halves.sides[1];
        left.first = range.first;
        right.last = range.last;
        if (best.axis < 0) {
            left.last = right.first = range.first + range.count() / 2;
            halve_by_center(range, left.last);
            for (Range<T>& side : halves.sides) {
                for (std::size_t i = side.first; i < side.last; ++i) side.add(boxes_[i]);
            }
        } else {
            left.last = right.first = part_at(range, binning, best, left, right);
        }
        left.depth = right.depth = range.depth + 1;
        return halves;
    }

    /// Moves the boxes that go left to the front; the first that does not is returned.
    std::size_t part_at(const Range<T>& range, const Binning<T>& binning, const Split<T>& best,
                        Range<T>& left, Range<T>& right) {
        const auto goes_left = [&](const BvhBox<T>& box) {
            return binning.one(center_of<T>(box), best.axis) <= best.bin;
        };
        std::size_t from = range.first, to = range.last;
        for (;;) {
            for (; from < to && goes_left(boxes_[from]); ++from) left.add(boxes_[from]);
            for (; from < to && !goes_left(boxes_[to - 1]); --to) right.add(boxes_[to - 1]);
            if (from == to) return from;
            std::swap(boxes_[from], boxes_[to - 1]);
        }
    }

    /// Puts the lower half along the axis on which the centres spread most to the front.
    void halve_by_center(const Range<T>& range, std::size_t middle) {
        const Vector<T> spread = range.centers.high - range.centers.low;
        const int axis = spread[0] >= spread[1] ? (spread[0] >= spread[2] ? 0 : 2)
                                                : (spread[1] >= spread[2] ? 1 : 2);
        if (!(spread[axis] > 0)) return;
        const auto at = [&](std::size_t i) {
            return boxes_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(range.first), at(middle), at(range.last),
                         [&](const BvhBox<T>& a, const BvhBox<T>& b) {
                             return center_of<T>(a)[axis] < center_of<T>(b)[axis];
                         });
    }

    const std::span<BvhBox<T>> boxes_;
    const BvhSettings settings_;
    std::vector<Task> tasks_;
};

}  // namespace

template <typename T>
typename Flat<T>::Index build_bvh(std::span<BvhBox<T>> boxes, const BvhSettings& settings,
                                  std::vector<typename Flat<T>::BvhNode>& nodes) {
    return Builder<T>(boxes, settings).build(nodes);
}

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

template f32::Index build_bvh<float>(std::span<f32::BvhNode>, const BvhSettings&,
                                     std::vector<f32::BvhNode>&);
template f64::Index build_bvh<double>(std::span<f64::BvhNode>, const BvhSettings&,
                                      std::vector<f64::BvhNode>&);
template BvhShape shape_of<float>(std::span<const f32::BvhNode>, f32::Index, const BvhSettings&);
template BvhShape shape_of<double>(std::span<const f64::BvhNode>, f64::Index, const BvhSettings&);

}  // namespace rt
