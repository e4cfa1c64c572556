// SPDX-License-Identifier: Apache-2.0
//
// kernels/bits.cl and kernels/power.cl: against frexp, ldexp, nextafter and the C library's long
// double logarithms and exponentials (64 bits), and bit for bit against host/trace. Bars are in
// roundoffs (half an ulp of 1), each a little above the largest error found.
#include <functional>

#include "host/trace/power.h"
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"

namespace rt {

namespace {

/// `count` numbers from low to high, both included.
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

/// What log_cosine is for: positive numbers up to 1, most of them normal and near 1.
template <typename T>
std::vector<T> numbers_up_to_one() {
    auto values = positive_numbers<T>();
    std::erase_if(values, [](T x) { return x > T(1); });
    const auto linear = evenly<T>(1e-5, 1, 60000);
    values.insert(values.end(), linear.begin(), linear.end());
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

template <typename T>
testing::AssertionResult same_as_twin(const std::string& function, const std::vector<T>& x,
                                      T (*twin)(T)) {
    return same_bits<T>(run<T, T>(function, x.size(), x),
                        for_each_item(x.size(), [&](std::size_t i) { return twin(x[i]); }));
}

/// A bar that is not the same in float and in double.
template <typename T>
double bar(double in_float, double in_double) {
    return std::is_same_v<T, float> ? in_float : in_double;
}

KERNEL_SUITE(ExponentOf);
TYPED_TEST(ExponentOf, IsFrexpsForNormalNumbers) {
    using Index = typename Flat<TypeParam>::Index;
    auto x = positive_numbers<TypeParam>();
    std::erase_if(x, [](TypeParam v) { return v < std::numeric_limits<TypeParam>::min(); });
    const auto exponents = run<TypeParam, Index>("exponent_of", x.size(), x);
    const auto mantissas = run<TypeParam, TypeParam>("mantissa_of", x.size(), x);
    for (std::size_t i = 0; i < x.size(); ++i) {
        int exponent = 0;
        const TypeParam half_mantissa = std::frexp(x[i], &exponent);
        ASSERT_EQ(exponents[i], exponent - 1) << x[i];
        ASSERT_EQ(mantissas[i], 2 * half_mantissa) << x[i];
        ASSERT_EQ(trace::exponent_of(x[i]), exponents[i]);
    }
    EXPECT_TRUE(same_as_twin<TypeParam>("mantissa_of", x, trace::mantissa_of));
}

KERNEL_SUITE(PowerOfTwo);
TYPED_TEST(PowerOfTwo, IsLdexpsForEveryNormalResult) {
    using Limits = std::numeric_limits<TypeParam>;
    std::vector<typename Flat<TypeParam>::Index> k;
    for (int e = Limits::min_exponent - 1; e < Limits::max_exponent; ++e) k.push_back(e);
    const auto powers = run<TypeParam, TypeParam>("power_of_two", k.size(), k);
    for (std::size_t i = 0; i < k.size(); ++i) {
        ASSERT_EQ(powers[i], std::ldexp(TypeParam(1), int(k[i])));
        ASSERT_EQ(trace::power_of_two<TypeParam>(k[i]), powers[i]);
    }
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
    EXPECT_TRUE(same_bits<TypeParam>(next, for_each_item(x.size(), [&](std::size_t i) {
                                         return trace::one_ulp_towards(x[i], direction[i]);
                                     })));
}

KERNEL_SUITE(AtanhTail);
TYPED_TEST(AtanhTail, IsItsSeries) {
    // (atanh(z) / z - 1) / z^2 = 1/3 + w/5 + w^2/7 + ... In float the polynomial is cut at w^3 and
    // off by 4e-6 of its value at the end, which is 1e-8 of the atanh.
    const auto x = evenly<TypeParam>(0, 0.0296, 60000);
    sweep<TypeParam>("atanh_tail", x, [](long double w) {
        long double sum = 0;
        for (int k = 61; k >= 3; k -= 2) sum = sum * w + 1.0L / k;
        return sum;
    }).expect_at_most(bar<TypeParam>(4, 1.5));
    EXPECT_TRUE(same_as_twin<TypeParam>("atanh_tail", x, [](TypeParam w) {
        return trace::horner(trace::PowerConstants<TypeParam>::atanh_tail, w);
    }));
}

KERNEL_SUITE(ExpSeries);
TYPED_TEST(ExpSeries, IsExpOverItsInterval) {
    const auto x = evenly<TypeParam>(-0.3466, 0.3466, 60001);
    sweep<TypeParam>("exp_series", x, [](long double r) {
        return std::exp(r);
    }).expect_at_most(1.25);
    EXPECT_TRUE(same_as_twin<TypeParam>("exp_series", x, [](TypeParam r) {
        return trace::horner(trace::PowerConstants<TypeParam>::exp_series, r);
    }));
}

KERNEL_SUITE(TwiceAtanh);
TYPED_TEST(TwiceAtanh, IsTwiceAtanhOverItsInterval) {
    auto x = evenly<TypeParam>(-0.172, 0.172, 60001);
    for (const TypeParam small : positive_numbers<TypeParam>()) {
        if (small < TypeParam(0.1)) x.push_back(small);
    }
    sweep<TypeParam>("twice_atanh", x, [](long double z) {
        return 2 * std::atanh(z);
    }).expect_at_most(1.25);
    EXPECT_TRUE(same_as_twin<TypeParam>("twice_atanh", x, trace::twice_atanh));
}

KERNEL_SUITE(LogCosine);
template <typename T>
void expect_log(const std::vector<T>& cosine, const std::vector<T>& gap,
                const std::function<long double(T, T)>& reference, double bar) {
    const auto logs = run<T, T>("log_cosine", cosine.size(), cosine, gap);
    WorstError worst;
    for (std::size_t i = 0; i < cosine.size(); ++i)
        worst.add(relative_error(logs[i], Quad(reference(cosine[i], gap[i]))));
    worst.expect_at_most(bar);
    EXPECT_TRUE(same_bits<T>(logs, for_each_item(cosine.size(), [&](std::size_t i) {
                                 return trace::log_cosine(cosine[i], gap[i]);
                             })));
}
TYPED_TEST(LogCosine, IsLog1pOfTheGapNearThePeak) {
    auto gap = evenly<TypeParam>(0, 0.2, 60000);
    // Gaps far below a roundoff, where 1 - gap is 1; above the numbers whose halves round.
    for (const TypeParam small : positive_numbers<TypeParam>()) {
        if (small < TypeParam(0.1) && small > 4 * std::numeric_limits<TypeParam>::min()) {
            gap.push_back(small);
        }
    }
    std::vector<TypeParam> cosine;
    for (const TypeParam g : gap)
        cosine.push_back(std::max(1 - g, std::nextafter(TypeParam(0.8125), TypeParam(1))));
    const auto log1p = [](TypeParam, TypeParam g) { return std::log1p(-(long double)g); };
    expect_log<TypeParam>(cosine, gap, log1p, 2.5);
}
TYPED_TEST(LogCosine, IsTheLogFartherOffSubnormalsIncluded) {
    auto cosine = numbers_up_to_one<TypeParam>();
    std::erase_if(cosine, [](TypeParam x) { return x > TypeParam(0.8125); });
    const std::vector<TypeParam> gap(cosine.size(), TypeParam(0.5));
    const auto log = [](TypeParam x, TypeParam) { return std::log((long double)x); };
    expect_log<TypeParam>(cosine, gap, log, 3);
}

KERNEL_SUITE(ExpNegative);
TYPED_TEST(ExpNegative, IsExpDownToTheSmallestNormalNumber) {
    const double lowest = trace::PowerConstants<TypeParam>::exp_lowest;
    auto y = evenly<TypeParam>(std::nextafter(TypeParam(lowest), TypeParam(0)), 0, 60000);
    for (const TypeParam x : positive_numbers<TypeParam>()) {
        if (x < TypeParam(1)) y.push_back(-x);
    }
    sweep<TypeParam>("exp_negative", y, [](long double v) {
        return std::exp(v);
    }).expect_at_most(1.5);
    EXPECT_TRUE(same_as_twin<TypeParam>("exp_negative", y, trace::exp_negative));
}
TYPED_TEST(ExpNegative, IsZeroBelowAndForNanAndOneAtZero) {
    const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
    const TypeParam lowest = trace::PowerConstants<TypeParam>::exp_lowest;
    const std::vector<TypeParam> y{
        lowest, -1e30f, -infinity, std::numeric_limits<TypeParam>::quiet_NaN(), 0, -TypeParam(0)};
    const std::vector<TypeParam> expected{0, 0, 0, 0, 1, 1};
    EXPECT_EQ((run<TypeParam, TypeParam>("exp_negative", y.size(), y)), expected);
    EXPECT_TRUE(same_as_twin<TypeParam>("exp_negative", y, trace::exp_negative));
}

constexpr double exponents[] = {0, 1e-3, 1, 10, 100, 1e4, 1e6};

/// Arguments of blinn_lobe.
template <typename T>
struct Lobes {
    std::vector<T> n_dot_h, half_gap, exponent;
    std::vector<long double> cosine_log;  ///< log(n.h), exactly

    /// From the gap, as shading makes it: n.h = 1 - half_gap is rounded.
    void add_gap(T gap, T power) {
        n_dot_h.push_back(static_cast<T>(1 - static_cast<long double>(gap)));
        half_gap.push_back(gap);
        exponent.push_back(power);
        cosine_log.push_back(std::log1p(-static_cast<long double>(gap)));
    }
    void add_cosine(T cosine, T power) {
        n_dot_h.push_back(cosine);
        half_gap.push_back(static_cast<T>(1 - static_cast<long double>(cosine)));
        exponent.push_back(power);
        cosine_log.push_back(std::log(static_cast<long double>(cosine)));
    }
    auto run_lobe() const {
        return run<T, T>("blinn_lobe", n_dot_h.size(), n_dot_h, half_gap, exponent);
    }
};

// 1.5 roundoffs are 9e-8 in float and 1.7e-16 in double; pow(n.h, e) is off by 0.45 at e = 1e6.
KERNEL_SUITE(BlinnLobe);
TYPED_TEST(BlinnLobe, IsThePowerForEveryExponentNearAndFarFromThePeak) {
    for (const double power : exponents) {
        Lobes<TypeParam> lobes;
        const TypeParam e = static_cast<TypeParam>(power);
        for (const TypeParam gap : evenly<TypeParam>(0, 0.187, 20000)) lobes.add_gap(gap, e);
        for (int i = 0; i < 20000; ++i) {
            lobes.add_gap(static_cast<TypeParam>(std::exp2(-2.5 - 60.0 * i / 20000)), e);
        }
        for (const TypeParam n_dot_h : evenly<TypeParam>(1e-4, 0.8125, 20000)) {
            lobes.add_cosine(n_dot_h, e);
        }
        const auto values = lobes.run_lobe();
        WorstError worst;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Quad exact_value = std::exp(static_cast<long double>(e) * lobes.cosine_log[i]);
            worst.add(error_in_roundoffs(values[i], exact_value, 1));
        }
        worst.expect_at_most(1.5, fmt::format("exponent_{:g}", power));
    }
}
TYPED_TEST(BlinnLobe, AtTheEdgesIsZeroOrOne) {
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    const TypeParam least = std::numeric_limits<TypeParam>::denorm_min();
    for (const double power : exponents) {
        const TypeParam e = static_cast<TypeParam>(power);
        const std::vector<TypeParam> n_dot_h{-1, -least, 0, nan, 1}, half_gap{2, 1, 1, nan, 0},
            exponent(5, e);
        const auto values = run<TypeParam, TypeParam>("blinn_lobe", 5, n_dot_h, half_gap, exponent);
        const TypeParam behind = power == 0 ? 1 : 0;
        EXPECT_EQ(values, (std::vector<TypeParam>{behind, behind, behind, behind, 1})) << power;
    }
}
TYPED_TEST(BlinnLobe, HasTheTwinsBits) {
    Random random(3);
    Lobes<TypeParam> lobes;
    for (const double power : exponents) {
        for (const TypeParam x : numbers_up_to_one<TypeParam>()) {
            lobes.add_cosine(x, static_cast<TypeParam>(power));
        }
        for (int i = 0; i < 5000; ++i) {
            lobes.add_cosine(random.any_number<TypeParam>(), static_cast<TypeParam>(power));
        }
    }
    EXPECT_TRUE(same_bits<TypeParam>(
        lobes.run_lobe(), for_each_item(lobes.n_dot_h.size(), [&](std::size_t i) {
            return trace::blinn_lobe(lobes.n_dot_h[i], lobes.half_gap[i], lobes.exponent[i]);
        })));
}

}  // namespace

}  // namespace rt
