// SPDX-License-Identifier: Apache-2.0
//
// A pixel's sample positions and weights, by formulas written out here: Burley's hashed Owen
// scrambling (JCGT 9(4), 2020) with a seed per pixel, and filters along both axes.
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "tests/kernel_runner.h"
#include "tests/test_random.h"

namespace rt {

namespace {

using Word = std::uint32_t;

Word reversed(Word v) {
    Word result = 0;
    for (int bit = 0; bit < 32; ++bit) result |= (v >> bit & 1u) << (31 - bit);
    return result;
}

/// Wellons' triple32.
Word hashed(Word v) {
    v = (v ^ v >> 17) * 0xed5ad4bbu;
    v = (v ^ v >> 11) * 0xac4c1b51u;
    v = (v ^ v >> 15) * 0x31848babu;
    return v ^ v >> 14;
}

/// Laine and Karras' permutation of the reversed bits, with Burley's constants.
Word scrambled(Word v, Word seed) {
    v = reversed(v) + seed;
    for (const Word factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) v ^= v * factor;
    return reversed(v);
}

/// The second dimension of Sobol's sequence: Pascal's triangle modulo two.
Word sobol_second(Word index) {
    Word result = 0;
    for (unsigned column = 0; column < 32; ++column) {
        if ((index >> column & 1u) == 0) continue;
        for (unsigned row = 0; row < 32; ++row) {
            if ((row & ~column) == 0) result ^= Word{1} << (31 - row);
        }
    }
    return result;
}

double unit(Word bits) { return (static_cast<double>(bits >> 20) + 0.5) / 4096; }

std::pair<double, double> sobol_unit(Word picture_seed, Word x, Word y, Word k) {
    const Word seed = hashed((y * 65536u + x) ^ hashed(picture_seed));
    const Word index = scrambled(k, hashed(seed));
    return {unit(scrambled(reversed(index), hashed(seed ^ 0x9e3779b9u))),
            unit(scrambled(sobol_second(index), hashed(seed ^ 0x85ebca6bu)))};
}

/// Mitchell and Netravali's cubic with B = C = 1/3, times two.
long double mitchell(long double d) {
    const long double inner = 7 * d * d * d - 12 * d * d + 16.0L / 3;
    const long double outer = -7.0L / 3 * d * d * d + 12 * d * d - 20 * d + 32.0L / 3;
    return (d < 1 ? inner : outer) / 3;
}

long double weight_along(int filter, long double d) {
    d = std::fabs(d);
    if (filter == 1) return 1 - d;
    if (filter == 2) return std::exp(-2 * d * d) - std::exp(-4.5L);
    return mitchell(d);
}

template <typename T>
struct Samples {
    using Index = typename Flat<T>::Index;
    std::vector<Index> x, y, k;
    std::vector<T> unit_x, unit_y, at_x, at_y, weight;
};

/// 3000 samples of random pixels in a large picture.
template <typename T>
Samples<T> random_samples(int filter, Word seed) {
    using Index = typename Flat<T>::Index;
    typename Flat<T>::LaunchParams params{};
    params.width = params.height = 65536;
    params.sampling = f32::RT_SAMPLES_SOBOL;
    params.samples = 16;
    params.filter = filter;
    params.seed = static_cast<decltype(params.seed)>(seed);
    Samples<T> samples;
    Random random(11);
    for (int i = 0; i < 3000; ++i) {
        samples.x.push_back(static_cast<Index>(random.uniform(0, 65536)));
        samples.y.push_back(static_cast<Index>(random.uniform(0, 65536)));
        samples.k.push_back(static_cast<Index>(random.uniform(0, 16)));
    }
    std::tie(samples.unit_x, samples.unit_y, samples.at_x, samples.at_y, samples.weight) =
        run<T, T, T, T, T, T>("sample", samples.x.size(), std::vector{params}, samples.x, samples.y,
                              samples.k);
    return samples;
}

KERNEL_SUITE(SobolSample);
TYPED_TEST(SobolSample, IsWherePixelAndSeedPutIt) {
    for (const Word seed : {0u, 3u, 12345u}) {
        const auto samples = random_samples<TypeParam>(0, seed);
        for (std::size_t i = 0; i < samples.x.size(); ++i) {
            const auto [x, y] =
                sobol_unit(seed, static_cast<Word>(samples.x[i]), static_cast<Word>(samples.y[i]),
                           static_cast<Word>(samples.k[i]));
            ASSERT_EQ(double(samples.unit_x[i]), x);
            ASSERT_EQ(double(samples.unit_y[i]), y);
        }
    }
}

TYPED_TEST(SobolSample, DiffersFromPixelToPixel) {
    using Index = typename Flat<TypeParam>::Index;
    typename Flat<TypeParam>::LaunchParams params{};
    params.width = params.height = 32;
    params.sampling = f32::RT_SAMPLES_SOBOL;
    params.samples = 1;
    std::vector<Index> x, y, k(1024, 0);
    for (Index i = 0; i < 1024; ++i) {
        x.push_back(i % 32);
        y.push_back(i / 32);
    }
    const auto [unit_x, unit_y, at_x, at_y, weight] =
        run<TypeParam, TypeParam, TypeParam, TypeParam, TypeParam, TypeParam>(
            "sample", x.size(), std::vector{params}, x, y, k);
    std::set<std::pair<TypeParam, TypeParam>> places;
    for (std::size_t i = 0; i < x.size(); ++i) places.insert({unit_x[i], unit_y[i]});
    EXPECT_GT(places.size(), 1000u);
}

KERNEL_SUITE(SampleWeight);
TYPED_TEST(SampleWeight, IsTheProductOfTheFilterInBothDirections) {
    const double u = double(Flat<TypeParam>::roundoff);
    for (const int filter : {1, 2, 3}) {
        const auto samples = random_samples<TypeParam>(filter, 1);
        for (std::size_t i = 0; i < samples.x.size(); ++i) {
            const long double exact = weight_along(filter, samples.at_x[i] - 0.5L) *
                                      weight_along(filter, samples.at_y[i] - 0.5L);
            // Each factor is off by at most 32 u (FilterWeight) and below 2.
            ASSERT_NEAR(double(samples.weight[i]), double(exact), 128 * u) << filter;
        }
    }
}

}  // namespace

}  // namespace rt
