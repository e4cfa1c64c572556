// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "host/base/parallel.h"
#include "host/flatten/bvh_bins.h"
#include "host/flatten/bvh_few.h"
#include "host/flatten/bvh_partition.h"

namespace rt::bvh {

namespace {

/// Moves the lower half along the axis of widest center spread to the front.
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

template <typename T>
Halves<T> halves_at(const Range<T>& range, std::size_t middle) {
    Halves<T> halves;
    halves.is_leaf = false;
    auto& [left, right] = halves.sides;
    left.first = range.first;
    left.last = right.first = middle;
    right.last = range.last;
    left.depth = right.depth = range.depth + 1;
    return halves;
}

/// The two sides of a range whose boxes are already in order.
template <typename T>
Halves<T> cut_at(std::span<const BvhBox<T>> boxes, const Range<T>& range, std::size_t middle) {
    Halves<T> halves = halves_at(range, middle);
    for (Range<T>& side : halves.sides) {
        for (std::size_t i = side.first; i < side.last; ++i) side.add(boxes[i]);
    }
    return halves;
}

/// Splits a range into halves of equal count.
template <typename T>
Halves<T> halve(std::span<BvhBox<T>> boxes, const Range<T>& range) {
    const std::size_t middle = range.first + range.count() / 2;
    halve_by_center(boxes, range, middle);
    return cut_at<T>(boxes, range, middle);
}

/// One range and what it becomes.
template <typename T>
class Splitting {
   public:
    Splitting(std::span<BvhBox<T>> boxes, const Range<T>& range, const BvhSettings& settings,
              T scale)
        : boxes_(boxes),
          own_(boxes.subspan(range.first, range.count())),
          range_(range),
          settings_(settings),
          scale_(scale) {}

    Halves<T> few() const {
        const Places<T> places = places_of<T>(own_);
        const Split<T> split = best_split<T>(bins_at<T>(places, own_), scale_);
        if (!pays(split)) return {};
        if (split.axis < 0) return halve<T>(boxes_, range_);
        sort_along<T>(split.axis, places, own_);
        return cut_at<T>(boxes_, range_, range_.first + static_cast<std::size_t>(split.bin) + 1);
    }

    Halves<T> many(int threads) const {
        const Binning<T> binning(range_.centers, own_.size() > 64 ? most_bins : most_bins / 2);
        Bins<T> bins;
        fill_bins<T>(own_, binning, threads, bins);
        const Split<T> split = best_split<T>(bins, scale_);
        if (!pays(split)) return {};
        if (split.axis < 0) return halve<T>(boxes_, range_);
        const Partition<T> parted = partition<T>(own_, binning, split, threads);
        Halves<T> halves = halves_at(range_, range_.first + parted.left_count);
        for (std::size_t side : {0, 1}) {
            halves.sides[side].bounds = split.bounds[side];
            halves.sides[side].centers = parted.centers[side];
        }
        return halves;
    }

   private:
    /// Whether a split is cheaper than a leaf, if a leaf is allowed.
    bool pays(const Split<T>& split) const {
        if (own_.size() > static_cast<std::size_t>(settings_.most_in_leaf)) return true;
        const Vector<T> d = (range_.bounds.high - range_.bounds.low) * scale_;
        const T area = d[0] * (d[1] + d[2]) + d[1] * d[2];
        const T inner = static_cast<T>(settings_.inner_cost) * area + split.cost;
        return inner < area * static_cast<T>(own_.size());
    }

    const std::span<BvhBox<T>> boxes_, own_;
    const Range<T>& range_;
    const BvhSettings& settings_;
    const T scale_;
};

}  // namespace

template <typename T>
Range<T> whole_range(std::span<const BvhBox<T>> boxes, int threads) {
    std::vector<Range<T>> parts((boxes.size() + run_length - 1) / run_length);
    for_each_run(boxes.size(), run_length, threads, [&](std::size_t first, std::size_t last) {
        Range<T>& part = parts[first / run_length];
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
    const int halvings = std::bit_width(range.count());
    const bool too_deep = range.depth + halvings >= max_bvh_depth;
    const Vector<T> size = range.bounds.high - range.bounds.low;
    const T scale = T(1) / std::max({size[0], size[1], size[2]});
    if (too_deep || !std::isfinite(scale)) {
        const bool fits = range.count() <= static_cast<std::size_t>(settings.most_in_leaf);
        return fits ? Halves<T>{} : halve<T>(boxes, range);
    }
    const Splitting<T> splitting(boxes, range, settings, scale);
    return range.count() <= few_boxes ? splitting.few() : splitting.many(threads);
}

template Range<float> whole_range<float>(std::span<const f32::BvhNode>, int);
template Range<double> whole_range<double>(std::span<const f64::BvhNode>, int);
template Halves<float> split_range<float>(std::span<f32::BvhNode>, const Range<float>&,
                                          const BvhSettings&, int);
template Halves<double> split_range<double>(std::span<f64::BvhNode>, const Range<double>&,
                                            const BvhSettings&, int);

}  // namespace rt::bvh
