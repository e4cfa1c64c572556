// SPDX-License-Identifier: Apache-2.0
//
// kernels/math.cl and two helpers of kernels/film.cl, against 113-bit arithmetic and closed forms.
// Tolerances are in roundoffs (half an ulp of 1).
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 60000;

/// Vectors with components of any sign and exponents within +-12.
template <typename T>
std::vector<Packed3<T>> ordinary_vectors(Random& random) {
    return many(
        count, [&] { return pack<T>(random.log_uniform(0x1p-12, 0x1p12) * random.unit_vector()); });
}
template <typename T>
std::vector<Packed3<T>> any_vectors(Random& random) {
    return many(count, [&] { return random.any_vector<T>(); });
}
template <typename T>
std::vector<T> any_numbers(Random& random) {
    return many(count, [&] { return random.any_number<T>(); });
}
template <typename T>
std::vector<Packed3<T>> unit_vectors(Random& random) {
    return many(count, [&] { return pack<T>(random.unit_vector()); });
}

// Results of the C++ operators: IEEE 754 leaves no choice.
KERNEL_SUITE(Arithmetic);
TYPED_TEST(Arithmetic, RoundsOnce) {
    using T = TypeParam;
    Random random(20);
    const auto a = any_numbers<T>(random), b = any_numbers<T>(random), c = any_numbers<T>(random);
    const auto expect = [&](const std::vector<T>& device, const auto& f) {
        EXPECT_TRUE(same_bits<T>(device, for_each_item(count, f)));
    };
    expect(run<T, T>("product", count, a, b), [&](std::size_t i) { return a[i] * b[i]; });
    expect(run<T, T>("quotient", count, a, b), [&](std::size_t i) { return a[i] / b[i]; });
    expect(run<T, T>("square_root", count, a), [&](std::size_t i) { return std::sqrt(a[i]); });
    expect(run<T, T>("fused", count, a, b, c),
           [&](std::size_t i) { return std::fma(a[i], b[i], c[i]); });
}
TYPED_TEST(Arithmetic, TakesTheSecondOfWhatCannotBeCompared) {
    using T = TypeParam;
    Random random(22);
    const auto a = any_numbers<T>(random), b = any_numbers<T>(random);
    EXPECT_TRUE(same_bits<T>(run<T, T>("min_of", count, a, b), for_each_item(count, [&](auto i) {
                                 return a[i] < b[i] ? a[i] : b[i];
                             })));
    EXPECT_TRUE(same_bits<T>(run<T, T>("max_of", count, a, b), for_each_item(count, [&](auto i) {
                                 return a[i] > b[i] ? a[i] : b[i];
                             })));
}
TYPED_TEST(Arithmetic, ShiftsBits) {
    Random random(21);
    const auto word = [&] { return static_cast<std::uint32_t>(random.uniform(0, 0x1p32)); };
    const auto a = many(count, word), b = many(count, word);
    const auto shifted = run<TypeParam, std::uint32_t>("shifted", count, a, b);
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(shifted[i], (a[i] << (b[i] & 31)) ^ (a[i] >> (b[i] & 31))) << i;
    }
}

KERNEL_SUITE(Load3);
TYPED_TEST(Load3, AndStore3CopyBits) {
    Random random(1);
    const auto a = any_vectors<TypeParam>(random);
    EXPECT_TRUE(same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("load3", count, a), a));
    EXPECT_TRUE(same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("store3", count, a), a));
}

KERNEL_SUITE(AddCounts);
TYPED_TEST(AddCounts, AddsEachKindIn64Bits) {
    using Counts = typename Flat<TypeParam>::RayCounts;
    const std::vector<Counts> a{{4, 1, 2, 3}, {0, 0xffffffff, 0, 0}, {9, 5, 0xffffffffff, 7}},
        b{{0xffffffff, 10, 20, 30}, {1, 1, 1, 0xffffffff}, {0, 0, 1, 2}};
    const auto sum = run<TypeParam, Counts>("add_counts", a.size(), a, b);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(sum[i].primary, a[i].primary + b[i].primary);
        EXPECT_EQ(sum[i].shadow, a[i].shadow + b[i].shadow);
        EXPECT_EQ(sum[i].mirror, a[i].mirror + b[i].mirror);
        EXPECT_EQ(sum[i].transmitted, a[i].transmitted + b[i].transmitted);
    }
}

/// Each component is the C++ operator's result, rounded once: IEEE 754 leaves no choice.
template <typename T, typename F>
testing::AssertionResult rounds_once(const std::string& function, F f) {
    Random random(2);
    const auto a = any_vectors<T>(random), b = any_vectors<T>(random);
    return same_bits<T>(run<T, Packed3<T>>(function, count, a, b),
                        for_each_item(count, [&](std::size_t i) -> Packed3<T> {
                            return {f(a[i].x, b[i].x), f(a[i].y, b[i].y), f(a[i].z, b[i].z)};
                        }));
}

KERNEL_SUITE(Componentwise);
TYPED_TEST(Componentwise, SumDifferenceAndProductRoundOnce) {
    using T = TypeParam;
    EXPECT_TRUE(rounds_once<T>("add3", [](T x, T y) { return x + y; }));
    EXPECT_TRUE(rounds_once<T>("sub3", [](T x, T y) { return x - y; }));
    EXPECT_TRUE(rounds_once<T>("mul3", [](T x, T y) { return x * y; }));
}
TYPED_TEST(Componentwise, ScalingAndDivisionRoundOnce) {
    Random random(2);
    const auto a = any_vectors<TypeParam>(random);
    const auto s = any_numbers<TypeParam>(random);
    EXPECT_TRUE(same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("scale3", count, s, a),
                                     for_each_item(count, [&](std::size_t i) -> Packed3<TypeParam> {
                                         return {s[i] * a[i].x, s[i] * a[i].y, s[i] * a[i].z};
                                     })));
    EXPECT_TRUE(same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("divide3", count, a, s),
                                     for_each_item(count, [&](std::size_t i) -> Packed3<TypeParam> {
                                         return {a[i].x / s[i], a[i].y / s[i], a[i].z / s[i]};
                                     })));
}
TYPED_TEST(Componentwise, SignsChangeAlone) {
    Random random(2);
    const auto a = any_vectors<TypeParam>(random);
    EXPECT_TRUE(
        same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("abs3", count, a),
                             for_each_item(count, [&](std::size_t i) -> Packed3<TypeParam> {
                                 return {std::abs(a[i].x), std::abs(a[i].y), std::abs(a[i].z)};
                             })));
    EXPECT_TRUE(same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("negate3", count, a),
                                     for_each_item(count, [&](std::size_t i) -> Packed3<TypeParam> {
                                         return {-a[i].x, -a[i].y, -a[i].z};
                                     })));
}

KERNEL_SUITE(Dot3);
TYPED_TEST(Dot3, IsWithinThreeRoundingsOfItsTerms) {
    Random random(3);
    const auto a = ordinary_vectors<TypeParam>(random), b = ordinary_vectors<TypeParam>(random);
    const auto sums = run<TypeParam, TypeParam>("dot3", count, a, b);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 p = exact(a[i]), q = exact(b[i]);
        const Quad terms = magnitude(p.x * q.x) + magnitude(p.y * q.y) + magnitude(p.z * q.z);
        worst.add(error_in_roundoffs(sums[i], dot(p, q), terms));
    }
    worst.expect_at_most(3.0, "worst");
}
TYPED_TEST(Dot3, IsExactWhereTheLastTermsCancel) {
    // (1 + e)^2 - 1 = 2 e + e^2 needs the product unrounded.
    const TypeParam e = std::ldexp(TypeParam(1), -(std::numeric_limits<TypeParam>::digits + 1) / 2);
    const std::vector<Packed3<TypeParam>> a{{1, 1 + e, 0}}, b{{-1, 1 + e, 0}};
    const auto sum = run<TypeParam, TypeParam>("dot3", 1, a, b);
    EXPECT_EQ(sum[0], 2 * e + e * e);
}

KERNEL_SUITE(AddScaled);
TYPED_TEST(AddScaled, RoundsOnce) {
    Random random(5);
    const auto a = ordinary_vectors<TypeParam>(random), b = ordinary_vectors<TypeParam>(random);
    const auto s = many(count, [&] { return static_cast<TypeParam>(random.uniform(-8, 8)); });
    const auto sums = run<TypeParam, Packed3<TypeParam>>("add_scaled", count, a, s, b);
    EXPECT_TRUE(
        same_bits<TypeParam>(sums, for_each_item(count, [&](std::size_t i) -> Packed3<TypeParam> {
                                 const Quad3 sum = exact(a[i]) + Quad(s[i]) * exact(b[i]);
                                 return {TypeParam(sum.x), TypeParam(sum.y), TypeParam(sum.z)};
                             })));
}

KERNEL_SUITE(AnyNumbers);
TYPED_TEST(AnyNumbers, GiveTheSameBitsEverywhere) {
    using T = TypeParam;
    Random random(4);
    const auto a = any_vectors<T>(random), b = any_vectors<T>(random);
    const auto s = any_numbers<T>(random), t = any_numbers<T>(random), u = any_numbers<T>(random),
               v = any_numbers<T>(random);
    run<T, T>("dot3", count, a, b);
    run<T, T>("length3", count, a);
    run<T, T>("difference_of_products", count, s, t, u, v);
    run<T, Packed3<T>>("add_scaled", count, a, s, b);
    run<T, Packed3<T>>("normalize3", count, a);
    run<T, Packed3<T>>("reflect3", count, a, b);
}

// a * b + c must not silently become one fma, or devices give different pictures.
KERNEL_SUITE(Contraction);
TYPED_TEST(Contraction, IsOff) {
    // (1 + e)^2 = 1 + 2 e + e^2, of which e^2 is rounded away
    constexpr TypeParam e = sizeof(TypeParam) == sizeof(float) ? 0x1p-12 : 0x1p-27;
    const std::vector<TypeParam> a{1 + e}, c{-1 - 2 * e};
    EXPECT_EQ((run<TypeParam, TypeParam>("multiply_add", 1, a, a, c)), std::vector<TypeParam>{0});
}

KERNEL_SUITE(Length3);
TYPED_TEST(Length3, IsWithinTwoAndAHalfRoundings) {
    Random random(7);
    const auto a = ordinary_vectors<TypeParam>(random);
    const auto lengths = run<TypeParam, TypeParam>("length3", count, a);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        worst.add(relative_error(lengths[i], length(exact(a[i]))));
    }
    worst.expect_at_most(2.5, "worst");
}
TYPED_TEST(Length3, IsExactOnPythagoreanQuadruples) {
    const std::vector<Packed3<TypeParam>> a{{2, 3, -6}, {1, 4, 8}, {0, -3, 4}, {0, 0, 0}};
    EXPECT_EQ((run<TypeParam, TypeParam>("length3", 4, a)), (std::vector<TypeParam>{7, 9, 5, 0}));
}

KERNEL_SUITE(Normalize3);
TYPED_TEST(Normalize3, IsWithinFourAndAHalfRoundings) {
    Random random(9);
    const auto a = ordinary_vectors<TypeParam>(random);
    const auto units = run<TypeParam, Packed3<TypeParam>>("normalize3", count, a);
    WorstError direction, norm;
    for (std::size_t i = 0; i < count; ++i) {
        direction.add(vector_error<TypeParam>(units[i], unit(exact(a[i])), 1));
        norm.add(error_in_roundoffs<TypeParam>(0, length(exact(units[i])) - 1, 1));
    }
    direction.expect_at_most(4.5, "direction");
    norm.expect_at_most(4.5, "norm");
}

KERNEL_SUITE(DifferenceOfProducts);
TYPED_TEST(DifferenceOfProducts, HasTheRightSignAndTwoRoundingsWhateverCancels) {
    Random random(11);
    const auto number = [&] {
        const double x = random.uniform(1, 2);
        return static_cast<TypeParam>(random.coin() ? x : -x);
    };
    const auto a = many(count, number), b = many(count, number), c = many(count, number);
    // d makes both products equal, up to its rounding error and a few ulps
    std::vector<TypeParam> d(count);
    for (std::size_t i = 0; i < count; ++i) {
        d[i] = a[i] * b[i] / c[i] * (1 + TypeParam(random.index(3)) * Flat<TypeParam>::roundoff);
    }
    const auto results = run<TypeParam, TypeParam>("difference_of_products", count, a, b, c, d);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad value = Quad(a[i]) * Quad(b[i]) - Quad(c[i]) * Quad(d[i]);
        ASSERT_EQ(results[i] > 0, value > 0) << i;
        ASSERT_EQ(results[i] < 0, value < 0) << i;
        worst.add(relative_error(results[i], value));
    }
    worst.expect_at_most(2.0, "worst");
}
TYPED_TEST(DifferenceOfProducts, ChangesItsSignAloneWithSwappedProducts) {
    Random random(12);
    const auto a = any_numbers<TypeParam>(random), b = any_numbers<TypeParam>(random),
               c = any_numbers<TypeParam>(random), d = any_numbers<TypeParam>(random);
    const auto forth = run<TypeParam, TypeParam>("difference_of_products", count, a, b, c, d);
    const auto back = run<TypeParam, TypeParam>("difference_of_products", count, c, d, a, b);
    for (std::size_t i = 0; i < count; ++i) {
        const auto sign = [](TypeParam x) { return (x > 0) - (x < 0); };
        if (std::isfinite(forth[i]) && std::isfinite(back[i])) {
            ASSERT_EQ(sign(forth[i]), -sign(back[i])) << i;
        }
    }
}

KERNEL_SUITE(Reflect3);
TYPED_TEST(Reflect3, TurnsTheNormalPartAround) {
    const std::vector<Packed3<TypeParam>> d{{1, -1, 0}, {0, 0, -1}, {3, 4, 5}},
        n{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, expected{{1, 1, 0}, {0, 0, 1}, {-3, 4, 5}};
    EXPECT_TRUE(
        same_bits<TypeParam>(run<TypeParam, Packed3<TypeParam>>("reflect3", 3, d, n), expected));
}
TYPED_TEST(Reflect3, IsWithinFourRoundingsForUnitVectors) {
    Random random(14);
    const auto d = unit_vectors<TypeParam>(random), n = unit_vectors<TypeParam>(random);
    const auto results = run<TypeParam, Packed3<TypeParam>>("reflect3", count, d, n);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 p = exact(d[i]), q = exact(n[i]);
        worst.add(vector_error<TypeParam>(results[i], p - 2 * dot(p, q) * q, 1));
    }
    worst.expect_at_most(4.0, "worst");
}

}  // namespace

}  // namespace rt::this_file
