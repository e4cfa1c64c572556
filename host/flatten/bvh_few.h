// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host/flatten/bvh_bins.h"

// Few enough boxes to sort, with one bin each: every split between two of them is considered.
namespace rt::bvh {

inline constexpr std::size_t few_boxes = 12;

/// The rank of each box on each axis when sorted by center; ties keep their order.
template <typename T>
using Places = std::array<Mask<T>, few_boxes>;

template <typename T>
Places<T> places_of(std::span<const BvhBox<T>> boxes);

template <typename T>
Bins<T> bins_at(const Places<T>& places, std::span<const BvhBox<T>> boxes);

template <typename T>
void sort_along(int axis, const Places<T>& places, std::span<BvhBox<T>> boxes);

}  // namespace rt::bvh
