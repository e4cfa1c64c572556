// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host/flatten/bvh_bins.h"

// Boxes that are few enough to be sorted, with a bin for each: every split between two of them is
// looked at.
namespace rt::bvh {

inline constexpr std::size_t few_boxes = 8;

/// Which place each box takes, on each axis, when they are sorted by their centers; equal ones stay
/// in order.
template <typename T>
using Places = std::array<Mask<T>, few_boxes>;

template <typename T>
Places<T> places_of(std::span<const BvhBox<T>> boxes);

template <typename T>
Bins<T> bins_at(const Places<T>& places, std::span<const BvhBox<T>> boxes);

template <typename T>
void sort_along(int axis, const Places<T>& places, std::span<BvhBox<T>> boxes);

}  // namespace rt::bvh
