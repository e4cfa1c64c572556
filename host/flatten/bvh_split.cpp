// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "host/flatten/bvh_bins.h"
#include "host/parallel.h"

namespace rt::bvh {

namespace {

/// Moves the boxes that go left to the front; the first that does not is returned.
template <typename T>
std::size_t move_left(std::span<BvhBox<T>> boxes, const Binning<T>& binning, const Split<T>& best,
                      Range<T>& left, Range<T>& right) {
    const auto goes_left = [&](const BvhBox<T>& box) {
        return binning.one(center_of<T>(box), best.axis) <= best.bin;
    };
    std::size_t from = left.first, to = right.last;
    for (;;) {
        for (; from < to && goes_left(boxes[from]); ++from) left.add(boxes[from]);
        for (; from < to && !goes_left(boxes[to - 1]); --to) right.add(boxes[to - 1]);
        if (from == to) return from;
        std::swap(boxes[from], boxes[to - 1]);
    }
}

/// Puts the lower half along the axis on which the centers spread most to the front.
template <typename T>
void halve_by_center(std::span<BvhBox<T>> boxes, const Range<T>& range, std::size_t middle) {
    const Vector<T> spread = range.centers.high - range.centers.low;
    const int axis = spread[0] >= spread[1] ? (spread[0] >= spread[2] ? 0 : 2)
                                            : (spread[1] >= spread[2] ? 1 : 2);
    if (!(spread[axis] > 0)) return;
    const auto at = [&](std::size_t i) { return boxes.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(range.first), at(middle), at(range.last),
                     [&](const BvhBox<T>& a, const BvhBox<T>& b) {
                         return center_of<T>(a)[axis] < center_of<T>(b)[axis];
                     });
}

/// The sides of a range before their boxes are known.
template <typename T>
Halves<T> open_sides(const Range<T>& range) {
    Halves<T> halves;
    halves.is_leaf = false;
    halves.sides[0].first = range.first;
    halves.sides[1].last = range.last;
    for (Range<T>& side : halves.sides) side.depth = range.depth + 1;
    return halves;
}

template <typename T>
Halves<T> split_at(std::span<BvhBox<T>> boxes, const Range<T>& range, const Binning<T>& binning,
                   const Split<T>& best) {
    Halves<T> halves = open_sides(range);
    auto& [left, right] = halves.sides;
    left.last = right.first = move_left(boxes, binning, best, left, right);
    return halves;
}

/// Halves a range by number.
template <typename T>
Halves<T> halve(std::span<BvhBox<T>> boxes, const Range<T>& range) {
    Halves<T> halves = open_sides(range);
    auto& [left, right] = halves.sides;
    left.last = right.first = range.first + range.count() / 2;
    halve_by_center(boxes, range, left.last);
    for (Range<T>& side : halves.sides) {
        for (std::size_t i = side.first; i < side.last; ++i) side.add(boxes[i]);
    }
    return halves;
}

}  // namespace

template <typename T>
Range<T> whole_range(std::span<const BvhBox<T>> boxes, int threads) {
    std::vector<Range<T>> parts((boxes.size() + binning_run - 1) / binning_run);
    for_each_run(boxes.size(), binning_run, threads, [&](std::size_t first, std::size_t last) {
        Range<T>& part = parts[first / binning_run];
        for (std::size_t i = first; i < last; ++i) part.add(boxes[i]);
    });
    Range<T> range;
    range.last = boxes.size();
    for (const Range<T>& part : parts) {
        range.bounds.add(part.bounds);
        range.centers.add(part.centers);
    }
    return range;
}

template <typename T>
Halves<T> split_range(std::span<BvhBox<T>> boxes, const Range<T>& range,
                      const BvhSettings& settings, int threads) {
    if (range.count() == 1) return {};
    const bool fits = range.count() <= static_cast<std::size_t>(settings.most_in_leaf);
    const int halvings = std::bit_width(range.count());
    const bool too_deep = range.depth + halvings >= max_bvh_depth;
    const Vector<T> size = range.bounds.high - range.bounds.low;
    const T scale = T(1) / std::max({size[0], size[1], size[2]});
    if (too_deep || !std::isfinite(scale)) return fits ? Halves<T>{} : halve<T>(boxes, range);
    const Binning<T> binning(range.centers);
    const Split<T> best =
        best_split<T>(boxes.subspan(range.first, range.count()), binning, scale, threads);
    if (fits) {
        const T area = range.bounds.area(scale);
        const T inner = static_cast<T>(settings.inner_cost) * area + best.cost;
        if (!(inner < area * static_cast<T>(range.count()))) return {};
    }
    return best.axis < 0 ? halve<T>(boxes, range) : split_at<T>(boxes, range, binning, best);
}

template Range<float> whole_range<float>(std::span<const f32::BvhNode>, int);
template Range<double> whole_range<double>(std::span<const f64::BvhNode>, int);
template Halves<float> split_range<float>(std::span<f32::BvhNode>, const Range<float>&,
                                          const BvhSettings&, int);
template Halves<double> split_range<double>(std::span<f64::BvhNode>, const Range<double>&,
                                            const BvhSettings&, int);

}  // namespace rt::bvh
