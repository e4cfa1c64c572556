// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_bins.h"

#include <array>
#include <vector>

#include "host/parallel.h"

namespace rt::bvh {

namespace {

template <typename T>
struct Bins {
    std::array<std::array<Bounds<T>, bin_count>, 3> bounds;
    std::array<std::array<std::size_t, bin_count>, 3> counts{};

    void add(const Bins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t bin = 0; bin < bin_count; ++bin) {
                bounds[axis][bin].add(other.bounds[axis][bin]);
                counts[axis][bin] += other.counts[axis][bin];
            }
        }
    }
};

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
Bins<T> binned(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, int threads) {
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

}  // namespace

template <typename T>
Split<T> best_split(std::span<const BvhBox<T>> boxes, const Binning<T>& binning, T scale,
                    int threads) {
    const Bins<T> bins = binned<T>(boxes, binning, threads);
    Split<T> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<T, bin_count> right_cost;
        Bounds<T> side;
        std::size_t on_side = 0;
        for (std::size_t bin = bin_count - 1; bin > 0; --bin) {
            side.add(bins.bounds[axis][bin]);
            on_side += bins.counts[axis][bin];
            right_cost[bin] = on_side > 0 ? side.area(scale) * static_cast<T>(on_side)
                                          : std::numeric_limits<T>::infinity();
        }
        side = Bounds<T>();
        on_side = 0;
        for (std::size_t bin = 0; bin + 1 < bin_count; ++bin) {
            side.add(bins.bounds[axis][bin]);
            on_side += bins.counts[axis][bin];
            if (on_side == 0) continue;
            const T cost = side.area(scale) * static_cast<T>(on_side) + right_cost[bin + 1];
            if (cost < best.cost) best = {static_cast<int>(axis), static_cast<int>(bin), cost};
        }
    }
    return best;
}

template Split<float> best_split<float>(std::span<const f32::BvhNode>, const Binning<float>&, float,
                                        int);
template Split<double> best_split<double>(std::span<const f64::BvhNode>, const Binning<double>&,
                                          double, int);

}  // namespace rt::bvh
