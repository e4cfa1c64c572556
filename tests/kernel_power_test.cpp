// SPDX-License-Identifier: Apache-2.0
//
// kernels/bits.cl and kernels/power.cl: against nextafter and the C library's long double
// logarithms and exponentials (64 bits). Tolerances are in roundoffs (half an ulp of 1), each a
// little above the largest error found.
#include <functional>
#include <numbers>

#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"

namespace rt::this_file {

namespace {

/// `count` evenly spaced numbers from low to high, inclusive.
template <typename T>
std::vector<T> evenly(double low, double high, std::size_t count) {
    std::vector<T> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(static_cast<T>(low + (high - low) * double(i) / double(count - 1)));
    }
    return values;
}

/// Positive, from the smallest subnormal to the largest number, and every power of two.
template <typename T>
std::vector<T> positive_numbers() {
    using Limits = std::numeric_limits<T>;
    Random random(1);
    std::vector<T> values;
    for (int e = Limits::min_exponent - Limits::digits; e < Limits::max_exponent; ++e) {
        for (int i = 0; i < 20; ++i) values.push_back(std::ldexp(T(random.uniform(1, 2)), e));
        values.push_back(std::ldexp(T(1), e));
        values.push_back(std::nextafter(std::ldexp(T(1), e), T(0)));
    }
    values.push_back(Limits::max());
    std::erase(values, T(0));
    return values;
}

/// The largest relative error of probe `function` over x.
template <typename T>
WorstError sweep(const std::string& function, const std::vector<T>& x,
                 const std::function<long double(long double)>& reference) {
    const auto y = run<T, T>(function, x.size(), x);
    WorstError worst;
    for (std::size_t i = 0; i < x.size(); ++i)
        worst.add(relative_error(y[i], Quad(reference(x[i]))));
    return worst;
}

/// A tolerance that differs between float and double.
template <typename T>
double bar(double in_float, double in_double) {
    return std::is_same_v<T, float> ? in_float : in_double;
}

KERNEL_SUITE(OneUlpTowards);
TYPED_TEST(OneUlpTowards, IsNextafter) {
    using Limits = std::numeric_limits<TypeParam>;
    std::vector<TypeParam> x, direction, expected;
    auto numbers = positive_numbers<TypeParam>();
    numbers.push_back(0);
    for (const TypeParam magnitude : numbers) {
        for (const TypeParam value : {magnitude, -magnitude}) {
            for (const TypeParam towards : {TypeParam(-1), TypeParam(0), -TypeParam(0),
                                            Limits::denorm_min(), Limits::max()}) {
                x.push_back(value);
                direction.push_back(towards);
                const TypeParam end = towards > 0 ? Limits::infinity() : -Limits::infinity();
                expected.push_back(towards == 0 ? value : std::nextafter(value, end));
            }
        }
    }
    const auto next = run<TypeParam, TypeParam>("one_ulp_towards", x.size(), x, direction);
    EXPECT_TRUE(same_bits<TypeParam>(next, expected));
}

constexpr long double log2_e = std::numbers::log2e_v<long double>;

KERNEL_SUITE(Log2Tail);
TYPED_TEST(Log2Tail, IsItsSeries) {
    // (atanh(z) / z - 1) / z^2 = 1/3 + w/5 + w^2/7 + ... The polynomial's error here causes 0.05
    // roundoffs in the logarithm in float, 0.01 in double.
    const auto x = evenly<TypeParam>(0, 0.04, 60000);
    sweep<TypeParam>("log2_tail", x, [](long double w) {
        long double sum = 0;
        for (int k = 61; k >= 3; k -= 2) sum = sum * w + 1.0L / k;
        return log2_e * sum;
    }).expect_at_most(bar<TypeParam>(90, 13));
}

KERNEL_SUITE(Exp2Series);
TYPED_TEST(Exp2Series, IsExp2OverItsInterval) {
    const auto x = evenly<TypeParam>(-0.5, 0.5, 60001);
    sweep<TypeParam>("exp2_series", x, [](long double r) {
        return std::exp2(r);
    }).expect_at_most(1.4);
}

KERNEL_SUITE(Log2Series);
TYPED_TEST(Log2Series, IsAtanhToTheBaseTwoOverItsInterval) {
    auto x = evenly<TypeParam>(-0.2, 0.2, 60001);
    for (const TypeParam small : positive_numbers<TypeParam>()) {
        if (small < TypeParam(0.1) && small > 2 * std::numeric_limits<TypeParam>::min()) {
            x.push_back(small);
        }
    }
    sweep<TypeParam>("log2_series", x, [](long double z) {
        return log2_e * std::atanh(z);
    }).expect_at_most(2.5);
}

/// Vectors s beside a unit vector n, by what shading knows of them.
template <typename T>
struct Vectors {
    std::vector<T> along, across, squared;  ///< n.s, |s - (n.s) n|^2, s.s
    std::vector<long double> log2;          ///< log2 of the cosine, from the rounded numbers

    /// The vector with this square and sine.
    void add_sine(T square, long double sine) {
        const auto off = static_cast<T>(square * sine * sine);
        push(static_cast<T>(std::sqrt(static_cast<long double>(square) - off)), off, square);
        log2.push_back(log2_e / 2 * std::log1p(-static_cast<long double>(off) / square));
    }
    /// The vector with this square and n.s.
    void add_along(T square, T length) {
        const long double l = length;
        push(length, static_cast<T>(square - l * l), square);
        log2.push_back(std::log2(l) - std::log2(static_cast<long double>(square)) / 2);
    }

   private:
    void push(T a, T b, T c) {
        along.push_back(a);
        across.push_back(b);
        squared.push_back(c);
    }
};

/// The smallest square that counts: below it, light and viewer are opposite.
template <typename T>
constexpr T least_squared = std::is_same_v<T, float> ? T(0x1p-100f) : T(0x1p-900);

/// Powers of two below this exponent may be 0: they are barely normal numbers.
template <typename T>
constexpr T exp2_lowest = std::numeric_limits<T>::min_exponent;

/// Squares of sums of two unit vectors: all mantissas, and the smallest.
template <typename T>
T any_square(Random& random) {
    if (random.index(10) == 0) return least_squared<T>;
    return static_cast<T>(random.coin() ? random.uniform(0.25, 4) : random.log_uniform(1e-12, 4));
}

/// Near the peak: cosines above sqrt(3)/2, with sines between `least` and 0.5, spaced evenly and
/// logarithmically.
template <typename T>
Vectors<T> near_the_peak(double least) {
    Random random(4);
    Vectors<T> vectors;
    for (int i = 0; i < 20000; ++i) {
        vectors.add_sine(any_square<T>(random), random.uniform(0, 0.5));
        vectors.add_sine(any_square<T>(random), random.log_uniform(least, 0.5));
    }
    return vectors;
}

/// Farther off: cosines up to 0.81.
template <typename T>
Vectors<T> off_the_peak() {
    Random random(5);
    Vectors<T> vectors;
    for (int i = 0; i < 40000; ++i) {
        const T square = any_square<T>(random);
        const double cosine =
            random.coin() ? random.uniform(0, 0.81) : random.log_uniform(1e-9, 0.81);
        vectors.add_along(square, static_cast<T>(cosine * std::sqrt(double(square))));
    }
    return vectors;
}

KERNEL_SUITE(Log2Cosine);
template <typename T>
void expect_log2(const Vectors<T>& v, double bar) {
    const auto logs = run<T, T>("log2_cosine", v.along.size(), v.along, v.across, v.squared);
    WorstError worst;
    for (std::size_t i = 0; i < logs.size(); ++i)
        worst.add(relative_error(logs[i], Quad(v.log2[i])));
    worst.expect_at_most(bar);
}
TYPED_TEST(Log2Cosine, IsRightNearThePeakWhereTheCosineRoundsToOne) {
    expect_log2(near_the_peak<TypeParam>(1e-14), 4);
}
TYPED_TEST(Log2Cosine, IsRightFartherOff) { expect_log2(off_the_peak<TypeParam>(), 4); }
TYPED_TEST(Log2Cosine, IsRightForSubnormalCosines) {
    Random random(6);
    Vectors<TypeParam> vectors;
    for (const TypeParam cosine : positive_numbers<TypeParam>()) {
        if (cosine < TypeParam(0.4)) {
            vectors.add_along(static_cast<TypeParam>(random.uniform(0.25, 4)), cosine);
        }
    }
    expect_log2(vectors, 1.25);
}

/// 2^x; the integer part of a large x would cost long double precision.
Quad exact_exp2(Quad x) {
    const long double whole = std::rint(static_cast<long double>(x));
    const auto rest = static_cast<long double>(x - Quad(whole));
    return Quad(std::ldexp(std::exp2(rest), static_cast<int>(whole)));
}

KERNEL_SUITE(Exp2OfProduct);
TYPED_TEST(Exp2OfProduct, IsExp2DownToTheSmallestNormalNumber) {
    Random random(7);
    std::vector<TypeParam> a, b;
    for (const TypeParam product : evenly<TypeParam>(exp2_lowest<TypeParam>, 0, 60000)) {
        const auto factor = static_cast<TypeParam>(random.log_uniform(1e-6, 1e6));
        a.push_back(factor);
        b.push_back(product / factor);
    }
    for (const TypeParam x : positive_numbers<TypeParam>()) {
        a.push_back(1);
        b.push_back(x < TypeParam(1) ? -x : TypeParam(-1) / x);
    }
    const auto powers = run<TypeParam, TypeParam>("exp2_of_product", a.size(), a, b);
    WorstError worst;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        const Quad product = Quad(a[i]) * Quad(b[i]);
        if (product < Quad(exp2_lowest<TypeParam>)) continue;
        worst.add(relative_error(powers[i], exact_exp2(product)));
        ASSERT_LE(powers[i], TypeParam(1));
    }
    worst.expect_at_most(1.5);
}
TYPED_TEST(Exp2OfProduct, IsZeroBelowAndForNanAndOneAtZero) {
    using Limits = std::numeric_limits<TypeParam>;
    const TypeParam lowest = exp2_lowest<TypeParam>;
    const std::vector<TypeParam> a{1, 1, 1, Limits::max(), 0, 1, 1, 0},
        b{lowest - 1, -1e30f, -Limits::infinity(), -1, -Limits::infinity(), Limits::quiet_NaN(),
          0,          -1};
    const std::vector<TypeParam> expected{0, 0, 0, 0, 0, 0, 1, 1};
    EXPECT_EQ((run<TypeParam, TypeParam>("exp2_of_product", a.size(), a, b)), expected);
}

constexpr double exponents[] = {0, 1e-3, 1, 10, 100, 1e4, 1e6};

template <typename T>
auto run_lobe(const Vectors<T>& v, T exponent) {
    const std::vector<T> exponents(v.along.size(), exponent);
    return run<T, T>("blinn_lobe", exponents.size(), v.along, v.across, v.squared, exponents);
}

// 1.5 roundoffs are 9e-8 in float and 1.7e-16 in double; pow(n.h, e) is off by 0.45 at e = 1e6.
KERNEL_SUITE(BlinnLobe);
TYPED_TEST(BlinnLobe, IsThePowerForEveryExponentNearAndFarFromThePeak) {
    for (const double power : exponents) {
        WorstError worst;
        for (const auto& vectors : {near_the_peak<TypeParam>(1e-9), off_the_peak<TypeParam>()}) {
            const auto lobes = run_lobe(vectors, static_cast<TypeParam>(power));
            const long double e = static_cast<TypeParam>(power);
            for (std::size_t i = 0; i < lobes.size(); ++i) {
                worst.add(error_in_roundoffs(lobes[i], Quad(std::exp2(e * vectors.log2[i])), 1));
            }
        }
        worst.expect_at_most(1.5, fmt::format("exponent_{:g}", power));
    }
}
TYPED_TEST(BlinnLobe, AtTheEdgesIsZeroOrOne) {
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    const TypeParam least = std::numeric_limits<TypeParam>::denorm_min();
    Vectors<TypeParam> vectors;
    vectors.along = {-1, -least, 0, nan, 1, least, least, 2};
    vectors.across = {3, 1, 1, nan, nan, 0, least, 0};
    vectors.squared = {4, 1, 1, nan, nan, 0, least, 4};
    for (const double power : exponents) {
        const TypeParam dark = power == 0 ? 1 : 0;
        EXPECT_EQ(run_lobe(vectors, static_cast<TypeParam>(power)),
                  (std::vector<TypeParam>{dark, dark, dark, dark, dark, dark, dark, 1}))
            << power;
    }
}
TYPED_TEST(BlinnLobe, LiesWithinZeroAndOneForAnyNumbers) {
    Random random(3);
    for (const double power : exponents) {
        Vectors<TypeParam> vectors;
        for (int i = 0; i < 40000; ++i) {
            vectors.along.push_back(random.any_number<TypeParam>());
            vectors.across.push_back(std::fabs(random.any_number<TypeParam>()));
            vectors.squared.push_back(std::fabs(random.any_number<TypeParam>()));
        }
        for (const TypeParam lobe : run_lobe(vectors, static_cast<TypeParam>(power))) {
            ASSERT_TRUE(lobe >= 0 && lobe <= 1) << lobe;
        }
    }
}

}  // namespace

}  // namespace rt::this_file
