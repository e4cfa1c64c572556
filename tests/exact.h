// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host/flatten/flat_types.h"

// The reference arithmetic of the kernel tests: 113 bits, enough for exact products of two doubles
// and for any formula here with 2^-50 of a double's error to spare. Independent of the renderer.
namespace rt {

using Quad = __float128;

struct Quad3 {
    Quad x, y, z;
};

template <typename P>
Quad3 exact(const P& p) {
    return {Quad(p.x), Quad(p.y), Quad(p.z)};
}

inline Quad3 operator+(Quad3 a, Quad3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Quad3 operator-(Quad3 a, Quad3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Quad3 operator*(Quad s, Quad3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline Quad dot(Quad3 a, Quad3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Quad3 cross(Quad3 a, Quad3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Quad magnitude(Quad x) { return x < 0 ? -x : x; }

/// One Newton step from the long double root: 64 bits become 128.
inline Quad square_root(Quad x) {
    if (!(x > 0)) return 0;
    const Quad root = std::sqrt(static_cast<long double>(x));
    return (root + x / root) / 2;
}
inline Quad length(Quad3 a) { return square_root(dot(a, a)); }
inline Quad3 unit(Quad3 a) { return (Quad(1) / length(a)) * a; }

/// |value - exact| as a multiple of T's roundoff and of `scale`; infinite for a NaN.
template <typename T>
double error_in_roundoffs(T value, Quad exact_value, Quad scale) {
    const Quad error = magnitude(Quad(value) - exact_value);
    if (!(error >= 0)) return INFINITY;
    return error == 0 ? 0 : static_cast<double>(error / (scale * Quad(Flat<T>::roundoff)));
}
template <typename T>
double relative_error(T value, Quad exact_value) {
    return error_in_roundoffs(value, exact_value, magnitude(exact_value));
}
/// The largest error of a component.
template <typename T, typename P>
double vector_error(const P& value, Quad3 exact_value, Quad scale) {
    return std::max({error_in_roundoffs<T>(value.x, exact_value.x, scale),
                     error_in_roundoffs<T>(value.y, exact_value.y, scale),
                     error_in_roundoffs<T>(value.z, exact_value.z, scale)});
}

/// The largest of many errors, noted in the test's report so that tolerances can be set close to
/// it.
class WorstError {
   public:
    void add(double error) { worst_ = std::max(worst_, error >= 0 ? error : double(INFINITY)); }

    void expect_at_most(double bar, const std::string& what = "worst") const {
        testing::Test::RecordProperty(what, fmt::format("{:.4g}", worst_));
        EXPECT_LE(worst_, bar) << what;
    }

   private:
    double worst_ = 0;
};

}  // namespace rt
