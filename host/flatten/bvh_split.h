// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include "host/flatten/bvh.h"

// Vectors wider than the build's instruction set are passed around, but only within the bvh files.
#pragma GCC diagnostic ignored "-Wpsabi"

// How build_bvh splits a node: bounds in registers, and a run of boxes with its bounds.
namespace rt::bvh {

/// Four numbers in one register; the fourth is 0.
template <typename T>
struct Lanes {
    typedef T Vector __attribute__((vector_size(4 * sizeof(T))));
    typedef typename Flat<T>::Index Mask __attribute__((vector_size(4 * sizeof(T))));
};
template <typename T>
using Vector = typename Lanes<T>::Vector;
template <typename T>
using Mask = typename Lanes<T>::Mask;

template <typename T>
Vector<T> load(const typename Flat<T>::Packed3& row) {
    Mask<T> bits;
    std::memcpy(&bits, &row, sizeof bits);
    bits &= Mask<T>{-1, -1, -1, 0};
    Vector<T> v;
    std::memcpy(&v, &bits, sizeof v);
    return v;
}

template <typename T>
struct Bounds {
    Vector<T> low, high;

    static Bounds none() {
        constexpr T huge = std::numeric_limits<T>::infinity();
        return {Vector<T>{huge, huge, huge, huge}, Vector<T>{-huge, -huge, -huge, -huge}};
    }
    void add(const Vector<T>& point_low, const Vector<T>& point_high) {
        low = point_low < low ? point_low : low;
        high = point_high > high ? point_high : high;
    }
    void add(const Bounds& other) { add(other.low, other.high); }
    /// Adds the point in the lanes where `where` is -1; it is 0 in the others.
    void add_where(const Mask<T>& where, const Vector<T>& point) {
        const auto point_or_nan = (Vector<T>)((Mask<T>)point | ~where);
        add(point_or_nan, point_or_nan);
    }
};

template <typename T>
Bounds<T> bounds_of(const BvhBox<T>& box) {
    return {load<T>(box.low), load<T>(box.high)};
}

/// Boxes first .. last with their bounds and those of their centers (times two).
template <typename T>
struct Range {
    std::size_t first = 0, last = 0;
    int depth = 0;
    Bounds<T> bounds = Bounds<T>::none(), centers = Bounds<T>::none();

    std::size_t count() const { return last - first; }

    void add(const BvhBox<T>& box) {
        const Bounds<T> added = bounds_of<T>(box);
        bounds.add(added);
        centers.add(added.low + added.high, added.low + added.high);
    }
};

template <typename T>
Vector<T> center_of(const BvhBox<T>& box) {
    return load<T>(box.low) + load<T>(box.high);
}

/// The outcome for a range: a leaf, or two adjacent ranges.
template <typename T>
struct Halves {
    bool is_leaf = true;
    std::array<Range<T>, 2> sides;
};

/// All boxes, at depth 0.
template <typename T>
Range<T> whole_range(std::span<const BvhBox<T>> boxes, int threads);

/// Chooses what a range becomes, and reorders its boxes to match. A leaf holds at most
/// most_in_leaf, and none lies deeper than max_bvh_depth.
template <typename T>
Halves<T> split_range(std::span<BvhBox<T>> boxes, const Range<T>& range, int threads);

}  // namespace rt::bvh
