// SPDX-License-Identifier: Apache-2.0
//
// Long runs are cut into pieces of fixed length. Each is partitioned on its own; then what lies
// before the middle but belongs after it is swapped with what lies after it but belongs before.
#include "host/flatten/bvh_partition.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "host/base/parallel.h"

namespace rt::bvh {

namespace {

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

}  // namespace

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

template Partition<float> partition<float>(std::span<f32::BvhNode>, const Binning<float>&,
                                           const Split<float>&, int);
template Partition<double> partition<double>(std::span<f64::BvhNode>, const Binning<double>&,
                                             const Split<double>&, int);

}  // namespace rt::bvh
