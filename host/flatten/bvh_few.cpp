// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/bvh_few.h"

#include <algorithm>

namespace rt::bvh {

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

template Places<float> places_of<float>(std::span<const f32::BvhNode>);
template Places<double> places_of<double>(std::span<const f64::BvhNode>);
template Bins<float> bins_at<float>(const Places<float>&, std::span<const f32::BvhNode>);
template Bins<double> bins_at<double>(const Places<double>&, std::span<const f64::BvhNode>);
template void sort_along<float>(int, const Places<float>&, std::span<f32::BvhNode>);
template void sort_along<double>(int, const Places<double>&, std::span<f64::BvhNode>);

}  // namespace rt::bvh
