// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host/flatten/flat_types.h"
#include "host/stress/wide_shapes.h"

// The reference arithmetic of the kernel tests, as of the stress suite: 113 bits, enough for exact
// products of two doubles and for any formula here with 2^-50 of a double's error to spare.
// Independent of the renderer.
namespace rt {

using stress::cross;
using stress::dot;
using stress::length;
using stress::magnitude;
using stress::Quad;
using stress::square_root;
using stress::unit;
using Quad3 = stress::Wide3<Quad>;

template <typename P>
Quad3 exact(const P& p) {
    return {Quad(p.x), Quad(p.y), Quad(p.z)};
}

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
