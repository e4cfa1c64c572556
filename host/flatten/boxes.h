// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flatten/bvh.h"

// Boxes that no ray that hits their contents can miss, in the arithmetic of kernels/: every
// coordinate is moved out by box_slack half-ulps of the box's largest one. The triangle test works
// on vertices rounded in the ray's frame, at most 8 half-ulps of |vertex| + |origin| off, and t is
// rounded once more; the origin's part is added to the ray (kernels/bvh.cl).
namespace rt {

inline constexpr int box_slack = 16;

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Sphere& sphere);

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Cone& cone);

/// For the vertices as rounded.
template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Packed3& a, const typename Flat<T>::Packed3& b,
                 const typename Flat<T>::Packed3& c);

}  // namespace rt
