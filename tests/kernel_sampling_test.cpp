// SPDX-License-Identifier: Apache-2.0
//
// kernels/sampling.cl: sample positions by formulas written out here, Burley's hashed Owen
// scrambling (JCGT 9(4), 2020) with a seed per pixel, and by the defining property of a (0,
// 2)-sequence; filters against their formulas in long double.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "host/scene/aa_mode.h"
#include "tests/kernel_runner.h"
#include "tests/test_random.h"

namespace rt::this_file {

namespace {

using Word = std::uint32_t;

std::vector<Word> random_words(std::size_t count) {
    Random random(7);
    std::vector<Word> words{0, 1, 0x80000000u, 0xffffffffu};
    while (words.size() < count) words.push_back(static_cast<Word>(random.uniform(0, 0x1p32)));
    return words;
}

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

/// Whether each of the 2^bits boxes of every shape 2^-a by 2^-(bits-a) holds one of 2^bits points.
template <typename T>
bool is_net(const std::vector<T>& x, const std::vector<T>& y, int bits) {
    for (int a = 0; a <= bits; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (std::size_t i = 0; i < x.size(); ++i) {
            boxes.insert({static_cast<int>(std::ldexp(x[i], a)),
                          static_cast<int>(std::ldexp(y[i], bits - a))});
        }
        if (boxes.size() != x.size()) return false;
    }
    return true;
}

/// Mitchell and Netravali's cubic as they write it, B = C = 1/3.
long double cubic(long double d) {
    const long double b = 1.0L / 3, c = 1.0L / 3;
    if (d < 1) {
        return ((12 - 9 * b - 6 * c) * d * d * d + (-18 + 12 * b + 6 * c) * d * d + 6 - 2 * b) / 6;
    }
    return ((-b - 6 * c) * d * d * d + (6 * b + 30 * c) * d * d + (-12 * b - 48 * c) * d + 8 * b +
            24 * c) /
           6;
}

/// Half the width of a filter's footprint: box, tent, Gaussian and Mitchell's.
double radius_of(std::int64_t filter) {
    const double radii[] = {0.5, 1, 1.5, 2};
    return radii[filter];
}

/// The weight along one axis, in the kernel's scale.
long double exact_weight(std::int64_t filter, long double distance) {
    const long double x = std::fabs(distance);
    if (filter == 0) return 1;
    if (filter == 1) return 1 - x;
    return filter == 2 ? std::exp(-2 * x * x) - std::exp(-4.5L) : 2 * cubic(x);
}

/// Uses Sobol samples if `grid` is 0.
template <typename T>
typename Flat<T>::LaunchParams params_with(int grid, int samples, int filter) {
    typename Flat<T>::LaunchParams params{};
    params.width = params.height = 65536;
    params.sampling = grid == 0 ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
    params.grid = grid;
    params.samples = samples;
    params.filter = filter;
    params.seed = 3;
    return params;
}

/// 3000 samples of random pixels in a large picture.
template <typename T>
struct Samples {
    using Index = typename Flat<T>::Index;
    std::vector<Index> x, y, k;
    std::vector<T> unit_x, unit_y, at_x, at_y, weight;

    explicit Samples(const typename Flat<T>::LaunchParams& params) {
        Random random(11);
        for (int i = 0; i < 3000; ++i) {
            x.push_back(static_cast<Index>(random.uniform(0, 65536)));
            y.push_back(static_cast<Index>(random.uniform(0, 65536)));
            k.push_back(static_cast<Index>(random.uniform(0, params.samples)));
        }
        std::tie(unit_x, unit_y, at_x, at_y, weight) =
            run<T, T, T, T, T, T>("sample", x.size(), std::vector{params}, x, y, k);
    }
};

KERNEL_SUITE(SampleBits);
TYPED_TEST(SampleBits, AreThoseOfTheFormulas) {
    const auto words = random_words(4000);
    const std::vector<Word> masks(words.size(), 0x00ff00ffu), shifts(words.size(), 8);
    const std::vector<Word> seeds(words.size(), 0x12345678u);
    const auto expect = [&](const char* function, const auto& formula, const auto&... more) {
        const auto device = run<TypeParam, Word>(function, words.size(), words, more...);
        for (std::size_t i = 0; i < words.size(); ++i) {
            ASSERT_EQ(device[i], formula(words[i])) << function << " of " << words[i];
        }
    };
    expect("reverse_bits", reversed);
    expect("hash_bits", hashed);
    expect("sobol_second", sobol_second);
    expect(
        "owen_scramble", [&](Word v) { return scrambled(v, seeds[0]); }, seeds);
    expect(
        "swap_bits", [](Word v) { return (v & 0xff00ff) << 8 | (v >> 8 & 0xff00ff); }, masks,
        shifts);
    const auto units = run<TypeParam, TypeParam>("unit_from_bits", words.size(), words);
    for (std::size_t i = 0; i < words.size(); ++i) ASSERT_EQ(double(units[i]), unit(words[i]));
}

KERNEL_SUITE(SobolSample);
TYPED_TEST(SobolSample, IsWherePixelAndSeedPutIt) {
    using Index = typename Flat<TypeParam>::Index;
    auto params = params_with<TypeParam>(0, 16, 0);
    for (const Word seed : {0u, 3u, 12345u}) {
        params.seed = static_cast<Index>(seed);
        const Samples<TypeParam> samples(params);
        for (std::size_t i = 0; i < samples.x.size(); ++i) {
            const auto [x, y] =
                sobol_unit(seed, static_cast<Word>(samples.x[i]), static_cast<Word>(samples.y[i]),
                           static_cast<Word>(samples.k[i]));
            ASSERT_EQ(double(samples.unit_x[i]), x);
            ASSERT_EQ(double(samples.unit_y[i]), y);
        }
    }
}

KERNEL_SUITE(SobolPosition);
TYPED_TEST(SobolPosition, AreANetInEveryElementaryInterval) {
    for (const Word seed : {0u, 1u, 77u, 0xdeadbeefu}) {
        for (const int bits : {2, 4, 6, 8}) {
            std::vector<Word> k(std::size_t{1} << bits);
            for (std::size_t i = 0; i < k.size(); ++i) k[i] = static_cast<Word>(i);
            const std::vector<Word> seeds(k.size(), seed);
            const auto [x, y] =
                run<TypeParam, TypeParam, TypeParam>("sobol_position", k.size(), seeds, k);
            EXPECT_TRUE(is_net(x, y, bits)) << "seed " << seed << ", 2^" << bits;
        }
    }
}

KERNEL_SUITE(FilterWeight);
TYPED_TEST(FilterWeight, FollowsItsFormula) {
    using T = TypeParam;
    using Index = typename Flat<T>::Index;
    const double u = double(Flat<T>::roundoff);
    for (const Index filter : {1, 2, 3}) {
        const double radius = radius_of(filter);
        std::vector<T> d;
        for (int i = -1000; i <= 1000; ++i) d.push_back(static_cast<T>(radius * i / 1000));
        const std::vector<Index> filters(d.size(), filter);
        const auto device = run<T, T>("filter_weight", d.size(), filters, d);
        EXPECT_EQ((run<T, T>("filter_radius", 1, std::vector<Index>{filter}))[0], T(radius));
        for (std::size_t i = 0; i < d.size(); ++i) {
            // The cubic's terms, up to 16, cancel at the rim.
            ASSERT_NEAR(double(device[i]), double(exact_weight(filter, d[i])), 32 * u)
                << filter << " at " << d[i];
        }
    }
}

KERNEL_SUITE(SamplePosition);
TYPED_TEST(SamplePosition, StaysInTheFootprintAndWeighsByTheFilter) {
    using T = TypeParam;
    const double u = double(Flat<T>::roundoff);
    for (const auto& [grid, count] : {std::pair{3, 9}, std::pair{0, 16}}) {
        for (const int filter : {0, 1, 2, 3}) {
            const Samples<T> samples(params_with<T>(grid, count, filter));
            const double radius = radius_of(filter);
            const auto expect_place = [&](T unit, T off) {
                ASSERT_TRUE(unit > 0 && unit < 1);
                ASSERT_LE(std::fabs(off), T(radius));
                ASSERT_NEAR(double(off), (double(unit) - 0.5) * 2 * radius, 2 * u);
            };
            for (std::size_t i = 0; i < samples.x.size(); ++i) {
                const T off_x = samples.at_x[i] - T(0.5), off_y = samples.at_y[i] - T(0.5);
                expect_place(samples.unit_x[i], off_x);
                expect_place(samples.unit_y[i], off_y);
                const long double right = exact_weight(filter, off_x) * exact_weight(filter, off_y);
                // Each factor is off by at most 32 u (FilterWeight) and below 2.
                ASSERT_NEAR(double(samples.weight[i]), double(right), 128 * u) << filter;
                ASSERT_TRUE(filter != 0 || samples.weight[i] == T(1));
            }
        }
    }
}

KERNEL_SUITE(GridPosition);
TYPED_TEST(GridPosition, IsExactForPowersOfTwoAndElseWithinAnUlpOfOne) {
    using Index = typename Flat<TypeParam>::Index;
    std::vector<Index> grid, k;
    for (Index n = 1; n <= AaMode::max_grid; ++n) {
        for (Index i = 0; i < n * n; ++i) {
            grid.push_back(n);
            k.push_back(i);
        }
    }
    const auto [x, y] = run<TypeParam, TypeParam, TypeParam>("grid_position", grid.size(), grid, k);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const bool is_power_of_two = (grid[i] & (grid[i] - 1)) == 0;
        const double ulp = is_power_of_two ? 0 : double(std::numeric_limits<TypeParam>::epsilon());
        ASSERT_NEAR(double(x[i]), (double(k[i] % grid[i]) + 0.5) / double(grid[i]), ulp);
        ASSERT_NEAR(double(y[i]), (double(k[i] / grid[i]) + 0.5) / double(grid[i]), ulp);
    }
}

}  // namespace

}  // namespace rt::this_file
