// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "host/base/parallel.h"

namespace rt::bvh {

namespace {

constexpr std::size_t most_bins = 16;
constexpr std::size_t run_length = 1 << 14;  ///< boxes that a thread processes at a time

/// Which of `count` bins a center (times two) falls into, on each axis.
template <typename T>
struct Binning {
    Vector<T> low, scale;
    std::size_t count;

    Binning(const Bounds<T>& centers, std::size_t bins) : low(centers.low), count(bins) {
        const T almost = T(bins) * (T(1) - 4 * Flat<T>::roundoff);
        for (int axis = 0; axis < 4; ++axis) {
            const T extent = axis < 3 ? centers.high[axis] - low[axis] : T(0);
            const T wanted = extent > 0 ? almost / extent : T(0);
            scale[axis] = std::isfinite(wanted) ? wanted : T(0);
        }
    }
    Mask<T> all(const Vector<T>& center) const {
        return __builtin_convertvector((center - low) * scale, Mask<T>);
    }
    int one(T center, int axis) const {
        return static_cast<int>((center - low[axis]) * scale[axis]);
    }
};

/// The contents of each bin, on each axis.
template <typename T>
struct Bins {
    std::size_t count = 0;
    std::array<std::array<Bounds<T>, 3>, most_bins> bounds;
    std::array<Mask<T>, most_bins> boxes;  ///< how many
};

/// The boxes in bins up to `bin` on `axis` go left; -1 if no split leaves boxes on both sides.
template <typename T>
struct Split {
    int axis = -1, bin = 0;
    T cost = std::numeric_limits<T>::infinity();  ///< area times count, of both sides
    std::array<Bounds<T>, 2> bounds{Bounds<T>::none(), Bounds<T>::none()};  ///< of the sides
};

constexpr std::size_t few_boxes = 12;

/// The rank of each box on each axis when sorted by center; ties keep their order.
template <typename T>
using Places = std::array<Mask<T>, few_boxes>;

/// The outcome of a partition: boxes that go left come first.
template <typename T>
struct Partition {
    std::size_t left_count = 0;
    std::array<Bounds<T>, 2> centers{Bounds<T>::none(), Bounds<T>::none()};  ///< left and right
};

constexpr std::size_t two_sets_from = 256;

template <typename T>
void clear(Bins<T>& bins, std::size_t count) {
    bins.count = count;
    for (std::size_t bin = 0; bin < count; ++bin) {
        bins.bounds[bin].fill(Bounds<T>::none());
        bins.boxes[bin] = Mask<T>{};
    }
}

template <typename T>
void merge(const Bins<T>& other, Bins<T>& bins) {
    for (std::size_t bin = 0; bin < bins.count; ++bin) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bins.bounds[bin][axis].add(other.bounds[bin][axis]);
        }
        bins.boxes[bin] += other.boxes[bin];
    }
}

template <typename T>
[[gnu::always_inline]] inline void add(const BvhBox<T>& box, const Binning<T>& binning,
                                       Bins<T>& bins) {
    const Bounds<T> added = bounds_of<T>(box);
    const Mask<T> bin = binning.all(added.low + added.high);
    // Constant lane indices: a loop over them would go through memory.
    const auto x = static_cast<std::size_t>(bin[0]), y = static_cast<std::size_t>(bin[1]);
    const auto z = static_cast<std::size_t>(bin[2]);
    bins.bounds[x][0].add(added);
    bins.bounds[y][1].add(added);
    bins.bounds[z][2].add(added);
    bins.boxes[x][0] += 1;
    bins.boxes[y][1] += 1;
    bins.boxes[z][2] += 1;
}

/// Long runs fill two sets of bins alternately: neighbors often fall into the same bin, and the
/// second would wait for the first.
template <typename T>
void fill_run(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, Bins<T>& bins) {
    clear(bins, binning.count);
    std::size_t i = 0;
    if (boxes.size() >= two_sets_from) {
        Bins<T> others;
        clear(others, binning.count);
        for (; i + 1 < boxes.size(); i += 2) {
            add(boxes[i], binning, bins);
            add(boxes[i + 1], binning, others);
        }
        merge(others, bins);
    }
    for (; i < boxes.size(); ++i) add(boxes[i], binning, bins);
}

/// Half the surface area of each axis's bounds, with lengths multiplied by `scale` first.
template <typename T>
Vector<T> areas(const std::array<Bounds<T>, 3>& bounds, T scale) {
    const Vector<T> a = (bounds[0].high - bounds[0].low) * scale;
    const Vector<T> b = (bounds[1].high - bounds[1].low) * scale;
    const Vector<T> c = (bounds[2].high - bounds[2].low) * scale;
    const Vector<T> ab_xy = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Vector<T> ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Vector<T> x = __builtin_shufflevector(ab_xy, c, 0, 1, 4, 7);
    const Vector<T> y = __builtin_shufflevector(ab_xy, c, 2, 3, 5, 7);
    const Vector<T> z = __builtin_shufflevector(ab_z, c, 0, 1, 6, 7);
    return x * (y + z) + y * z;
}

/// One side of a split, on each axis.
template <typename T>
struct Side {
    std::array<Bounds<T>, 3> bounds{Bounds<T>::none(), Bounds<T>::none(), Bounds<T>::none()};
    Mask<T> boxes{};

    void add(const Bins<T>& bins, std::size_t bin) {
        for (std::size_t axis = 0; axis < 3; ++axis) bounds[axis].add(bins.bounds[bin][axis]);
        boxes += bins.boxes[bin];
    }
    /// Area times count; NaN, which never compares as less, if the side is empty.
    Vector<T> costs(T scale) const {
        return areas<T>(bounds, scale) * __builtin_convertvector(boxes, Vector<T>);
    }
};

/// Bins the boxes with `threads` threads; the outcome does not depend on how many.
template <typename T>
void fill_bins(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, int threads,
               Bins<T>& bins) {
    if (boxes.size() <= run_length) return fill_run<T>(boxes, binning, bins);
    std::vector<Bins<T>> parts((boxes.size() + run_length - 1) / run_length);
    for_each_run(boxes.size(), run_length, threads, [&](std::size_t first, std::size_t last) {
        fill_run<T>(boxes.subspan(first, last - first), binning, parts[first / run_length]);
    });
    bins = parts[0];
    for (std::size_t part = 1; part < parts.size(); ++part) merge(parts[part], bins);
}

/// The split of least cost. Lengths are multiplied by `scale` before areas are computed.
template <typename T>
Split<T> best_split(const Bins<T>& bins, T scale) {
    std::array<Vector<T>, most_bins> right_costs;
    Side<T> right;
    for (std::size_t bin = bins.count - 1; bin > 0; --bin) {
        right.add(bins, bin);
        right_costs[bin] = right.costs(scale);
    }
    Side<T> left;
    Vector<T> least = Bounds<T>::none().low;
    Mask<T> least_bin{};
    for (std::size_t bin = 0; bin + 1 < bins.count; ++bin) {
        left.add(bins, bin);
        const Vector<T> costs = left.costs(scale) + right_costs[bin + 1];
        const Mask<T> is_less = costs < least;
        least = is_less ? costs : least;
        least_bin = is_less ? Mask<T>{} + static_cast<typename Flat<T>::Index>(bin) : least_bin;
    }
    Split<T> best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(least[axis] < best.cost)) continue;
        best.axis = axis;
        best.bin = static_cast<int>(least_bin[axis]);
        best.cost = least[axis];
    }
    if (best.axis < 0) return best;
    for (int bin = 0; bin < static_cast<int>(bins.count); ++bin) {
        best.bounds[bin > best.bin ? 1 : 0].add(
            bins.bounds[static_cast<std::size_t>(bin)][static_cast<std::size_t>(best.axis)]);
    }
    return best;
}

template <typename T>
Places<T> places_of(std::span<const BvhBox<T>> boxes) {
    Places<T> places;
    std::array<Vector<T>, few_boxes> centers;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        centers[i] = center_of<T>(boxes[i]);
        places[i] = Mask<T>{};
        for (std::size_t j = 0; j < i; ++j) {
            const Mask<T> minus_after = centers[j] <= centers[i];
            places[i] -= minus_after;
            places[j] += minus_after + 1;
        }
    }
    return places;
}

template <typename T>
Bins<T> bins_at(const Places<T>& places, std::span<const BvhBox<T>> boxes) {
    Bins<T> bins;
    bins.count = boxes.size();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Bounds<T> bounds = bounds_of<T>(boxes[i]);
        bins.bounds[static_cast<std::size_t>(places[i][0])][0] = bounds;
        bins.bounds[static_cast<std::size_t>(places[i][1])][1] = bounds;
        bins.bounds[static_cast<std::size_t>(places[i][2])][2] = bounds;
        bins.boxes[i] = Mask<T>{} + 1;
    }
    return bins;
}

template <typename T>
void sort_along(int axis, const Places<T>& places, std::span<BvhBox<T>> boxes) {
    std::array<BvhBox<T>, few_boxes> sorted;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        sorted[static_cast<std::size_t>(places[i][axis])] = boxes[i];
    }
    std::copy_n(sorted.begin(), boxes.size(), boxes.begin());
}

/// Branch-free, because where a box goes is unpredictable.
template <typename T>
Partition<T> partition_piece(std::span<BvhBox<T>> boxes, const Binning<T>& binning,
                             const Split<T>& split) {
    using Packed3 = typename Flat<T>::Packed3;
    constexpr std::array coordinates{&Packed3::x, &Packed3::y, &Packed3::z};
    const auto coordinate = coordinates[static_cast<std::size_t>(split.axis)];
    Bounds<T> left = Bounds<T>::none(), right = Bounds<T>::none();
    std::size_t middle = 0;
    for (BvhBox<T>& place : boxes) {
        const BvhBox<T> box = place;
        const int bin = binning.one(box.low.*coordinate + box.high.*coordinate, split.axis);
        const typename Flat<T>::Index goes_left = bin <= split.bin ? 1 : 0;
        place = boxes[middle];
        boxes[middle] = box;
        middle += static_cast<std::size_t>(goes_left);
        const Vector<T> center = center_of<T>(box);
        left.add_where(Mask<T>{} - goes_left, center);
        right.add_where(Mask<T>{} - (1 - goes_left), center);
    }
    return {middle, {left, right}};
}

struct Run {
    std::size_t first, count;
};

template <typename T>
void swap_runs(std::span<BvhBox<T>> boxes, std::vector<Run> lefts, std::vector<Run> rights,
               int threads) {
    struct Swap {
        std::size_t left, right, count;
    };
    std::vector<Swap> swaps;
    while (!lefts.empty()) {
        Run &left = lefts.back(), &right = rights.back();
        const std::size_t count = std::min(left.count, right.count);
        swaps.push_back({left.first, right.first, count});
        left = {left.first + count, left.count - count};
        right = {right.first + count, right.count - count};
        if (left.count == 0) lefts.pop_back();
        if (right.count == 0) rights.pop_back();
    }
    for_each_run(swaps.size(), 1, threads, [&](std::size_t i, std::size_t) {
        const auto [left, right, count] = swaps[i];
        std::ranges::swap_ranges(boxes.subspan(left, count), boxes.subspan(right, count));
    });
}

/// Moves the boxes that go left to the front, in place, with `threads` threads; the resulting order
/// does not depend on how many.
template <typename T>
Partition<T> partition(std::span<BvhBox<T>> boxes, const Binning<T>& binning, const Split<T>& split,
                       int threads) {
    if (boxes.size() <= run_length) return partition_piece<T>(boxes, binning, split);
    std::vector<Partition<T>> pieces((boxes.size() + run_length - 1) / run_length);
    for_each_run(boxes.size(), run_length, threads, [&](std::size_t first, std::size_t last) {
        pieces[first / run_length] =
            partition_piece<T>(boxes.subspan(first, last - first), binning, split);
    });
    Partition<T> whole;
    for (const Partition<T>& piece : pieces) {
        whole.left_count += piece.left_count;
        for (std::size_t side : {0, 1}) whole.centers[side].add(piece.centers[side]);
    }
    std::vector<Run> lefts, rights;  // on the wrong side of the middle
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::size_t first = i * run_length, end = std::min(first + run_length, boxes.size());
        const std::size_t cut = first + pieces[i].left_count, middle = whole.left_count;
        if (std::max(first, middle) < cut) {
            lefts.push_back({std::max(first, middle), cut - std::max(first, middle)});
        }
        if (cut < std::min(end, middle)) rights.push_back({cut, std::min(end, middle) - cut});
    }
    swap_runs<T>(boxes, std::move(lefts), std::move(rights), threads);
    return whole;
}

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
    Splitting(std::span<BvhBox<T>> boxes, const Range<T>& range, T scale)
        : boxes_(boxes),
          own_(boxes.subspan(range.first, range.count())),
          range_(range),
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
        if (own_.size() > most_in_leaf) return true;
        const Vector<T> d = (range_.bounds.high - range_.bounds.low) * scale_;
        const T area = d[0] * (d[1] + d[2]) + d[1] * d[2];
        const T inner = T(bvh_inner_cost) * area + split.cost;
        return inner < area * static_cast<T>(own_.size());
    }

    const std::span<BvhBox<T>> boxes_, own_;
    const Range<T>& range_;
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
Halves<T> split_range(std::span<BvhBox<T>> boxes, const Range<T>& range, int threads) {
    if (range.count() == 1) return {};
    const int halvings = std::bit_width(range.count());
    const bool too_deep = range.depth + halvings >= max_bvh_depth;
    const Vector<T> size = range.bounds.high - range.bounds.low;
    const T scale = T(1) / std::max({size[0], size[1], size[2]});
    if (too_deep || !std::isfinite(scale)) {
        return range.count() <= most_in_leaf ? Halves<T>{} : halve<T>(boxes, range);
    }
    const Splitting<T> splitting(boxes, range, scale);
    return range.count() <= few_boxes ? splitting.few() : splitting.many(threads);
}

template Range<float> whole_range<float>(std::span<const f32::BvhNode>, int);
template Range<double> whole_range<double>(std::span<const f64::BvhNode>, int);
template Halves<float> split_range<float>(std::span<f32::BvhNode>, const Range<float>&, int);
template Halves<double> split_range<double>(std::span<f64::BvhNode>, const Range<double>&, int);

}  // namespace rt::bvh
