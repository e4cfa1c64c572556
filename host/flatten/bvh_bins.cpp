// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_bins.h"

#include <vector>

#include "host/base/parallel.h"

namespace rt::bvh {

namespace {

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

}  // namespace

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

template void fill_bins<float>(std::span<const f32::BvhNode>, const Binning<float>&, int,
                               Bins<float>&);
template void fill_bins<double>(std::span<const f64::BvhNode>, const Binning<double>&, int,
                                Bins<double>&);
template Split<float> best_split<float>(const Bins<float>&, float);
template Split<double> best_split<double>(const Bins<double>&, double);

}  // namespace rt::bvh
