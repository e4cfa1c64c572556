// SPDX-License-Identifier: Apache-2.0
//
// kernels/sampling.cl: bits against their definitions, Sobol points by the defining property of a
// (0, 2)-sequence, filters against their formulas in long double.
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <set>

#include "host/scene/aa_mode.h"
#include "tests/kernel_runner.h"
#include "tests/test_random.h"

namespace rt {

namespace {

using Word = std::uint32_t;

std::vector<Word> random_words(std::size_t count) {
    Random random(7);
    std::vector<Word> words{0, 1, 0x80000000u, 0xffffffffu};
    while (words.size() < count) words.push_back(static_cast<Word>(random.uniform(0, 0x1p32)));
    return words;
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
    params.width = 640;
    params.height = 480;
    params.sampling = grid == 0 ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
    params.grid = grid;
    params.samples = samples;
    params.filter = filter;
    params.seed = 3;
    return params;
}

KERNEL_SUITE(ReverseBits);
TYPED_TEST(ReverseBits, AreTheWordBackwards) {
    const auto words = random_words(4000);
    const auto device = run<TypeParam, Word>("reverse_bits", words.size(), words);
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string text = std::bitset<32>(words[i]).to_string();
        std::reverse(text.begin(), text.end());
        ASSERT_EQ(device[i], std::bitset<32>(text).to_ulong());
    }
}

KERNEL_SUITE(SwapBits);
TYPED_TEST(SwapBits, ExchangesNeighboringBytes) {
    const auto words = random_words(1000);
    const std::vector<Word> masks(words.size(), 0x00ff00ffu), shifts(words.size(), 8);
    const auto device = run<TypeParam, Word>("swap_bits", words.size(), words, masks, shifts);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Word v = words[i];
        const Word expected = (v & 0xff) * 0x100u + (v >> 8 & 0xff) +
                              (v >> 16 & 0xff) * 0x1000000u + (v >> 24) * 0x10000u;
        ASSERT_EQ(device[i], expected);
    }
}

KERNEL_SUITE(HashBits);
TYPED_TEST(HashBits, EveryInputBitMovesAboutHalfOfTheOutput) {
    const auto words = random_words(2000);
    const auto hashes = run<TypeParam, Word>("hash_bits", words.size(), words);
    for (int bit = 0; bit < 32; ++bit) {
        auto flipped = words;
        for (Word& word : flipped) word ^= Word{1} << bit;
        const auto others = run<TypeParam, Word>("hash_bits", words.size(), flipped);
        double moved = 0;
        for (std::size_t i = 0; i < words.size(); ++i) {
            moved += static_cast<double>(std::bitset<32>(hashes[i] ^ others[i]).count());
        }
        EXPECT_NEAR(moved / static_cast<double>(words.size()), 16, 0.5) << "bit " << bit;
    }
}

KERNEL_SUITE(OwenScramble);
TYPED_TEST(OwenScramble, KeepsCommonPrefixesAndNothingMore) {
    const auto words = random_words(4000);
    const std::vector<Word> seeds(words.size(), 0x12345678u);
    const auto device = run<TypeParam, Word>("owen_scramble", words.size(), words, seeds);
    for (int bits = 1; bits < 32; ++bits) {
        auto others = words;
        for (Word& word : others) word ^= Word{1} << (31 - bits);
        const auto scrambled = run<TypeParam, Word>("owen_scramble", words.size(), others, seeds);
        for (std::size_t i = 0; i < words.size(); ++i) {
            const Word difference = device[i] ^ scrambled[i];
            ASSERT_EQ(std::countl_zero(difference), bits);
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

TYPED_TEST(SobolPosition, SecondDimensionIsPascalsTriangleModTwo) {
    std::vector<Word> powers;
    for (int i = 0; i < 32; ++i) powers.push_back(Word{1} << i);
    const auto columns = run<TypeParam, Word>("sobol_second", powers.size(), powers);
    for (unsigned column = 0; column < 32; ++column) {
        for (unsigned row = 0; row < 32; ++row) {
            // binomial(column, row) is odd when row's bits are among column's (Lucas 1878)
            const bool odd = (row & ~column) == 0;
            EXPECT_EQ((columns[column] >> (31 - row) & 1u) != 0, odd);
        }
    }
}

KERNEL_SUITE(UnitFromBits);
TYPED_TEST(UnitFromBits, IsTheMiddleOfItsCell) {
    const auto words = random_words(4000);
    const auto device = run<TypeParam, TypeParam>("unit_from_bits", words.size(), words);
    for (std::size_t i = 0; i < words.size(); ++i) {
        ASSERT_EQ(double(device[i]), (std::floor(words[i] / 1048576.0) + 0.5) / 4096);
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
    using Index = typename Flat<T>::Index;
    Random random(5);
    for (const auto& [grid, samples] : {std::pair{3, 9}, std::pair{0, 16}}) {
        for (const int filter : {0, 1, 2, 3}) {
            const auto params = params_with<T>(grid, samples, filter);
            std::vector<Index> x, y, k;
            for (int i = 0; i < 5000; ++i) {
                x.push_back(static_cast<Index>(random.uniform(0, 65536)));
                y.push_back(static_cast<Index>(random.uniform(0, 65536)));
                k.push_back(static_cast<Index>(random.uniform(0, samples)));
            }
            const auto [unit_x, unit_y, sample_x, sample_y, weight] =
                run<T, T, T, T, T, T>("sample", x.size(), std::vector{params}, x, y, k);
            const T radius = T(radius_of(filter));
            for (std::size_t i = 0; i < x.size(); ++i) {
                ASSERT_TRUE(unit_x[i] > 0 && unit_x[i] < 1 && unit_y[i] > 0 && unit_y[i] < 1);
                const T off_x = sample_x[i] - T(0.5), off_y = sample_y[i] - T(0.5);
                ASSERT_LE(std::max(std::fabs(off_x), std::fabs(off_y)), radius);
                const double u = double(Flat<T>::roundoff);
                ASSERT_NEAR(double(off_x), (double(unit_x[i]) - 0.5) * 2 * double(radius), 2 * u);
                ASSERT_NEAR(double(off_y), (double(unit_y[i]) - 0.5) * 2 * double(radius), 2 * u);
                const long double right = exact_weight(filter, off_x) * exact_weight(filter, off_y);
                ASSERT_NEAR(double(weight[i]), double(right), 256 * u) << filter;
                ASSERT_TRUE(filter != 0 || weight[i] == T(1));
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

}  // namespace rt
