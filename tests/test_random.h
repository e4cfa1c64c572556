// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "host/flatten/flat_types.h"

namespace rt {

/// Rays per scene of a test: MIRRORBALL_TEST_RAYS if that is a number, else `otherwise`.
inline std::size_t ray_count(std::size_t otherwise = 20000) {
    const char* count = std::getenv("MIRRORBALL_TEST_RAYS");
    const std::size_t asked = count ? std::strtoul(count, nullptr, 10) : 0;
    return asked > 0 ? asked : otherwise;
}

/// Repeatable random numbers for tests. Everything but `real_number` is made in double and rounded.
class Random {
   public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    /// in [0, count)
    int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    bool coin() { return index(2) == 1; }

    glm::dvec3 unit_vector() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * M_PI);
        const double radius = std::sqrt(1 - z * z);
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }
    glm::dvec3 in_cube(double half) {
        const double x = uniform(-half, half), y = uniform(-half, half);
        return {x, y, uniform(-half, half)};
    }

    /// Any sign and exponent: mostly within 2^-20..2^20, sometimes a special value.
    template <typename T>
    T any_number() {
        const auto& special = special_numbers<T>();
        if (index(6) == 0) return special[static_cast<std::size_t>(index(int(special.size())))];
        const double magnitude = log_uniform(0x1p-20, 0x1p20);
        return static_cast<T>(coin() ? magnitude : -magnitude);
    }
    template <typename T>
    typename Flat<T>::Packed3 any_vector() {
        const T x = any_number<T>(), y = any_number<T>();
        return {x, y, any_number<T>()};
    }

    /// Zeros, subnormals, the ends of the range, infinities, NaN and the neighbors of 1.
    template <typename T>
    static const std::vector<T>& special_numbers() {
        using Limits = std::numeric_limits<T>;
        static const std::vector<T> numbers = [] {
            std::vector<T> list{T(0),
                                Limits::denorm_min(),
                                T(12345) * Limits::denorm_min(),
                                Limits::min() - Limits::denorm_min(),
                                Limits::min(),
                                T(1) - Limits::epsilon() / 2,
                                T(1),
                                T(1) + Limits::epsilon(),
                                T(3),
                                Limits::max(),
                                Limits::infinity()};
            const std::size_t positive = list.size();
            for (std::size_t i = 0; i < positive; ++i) list.push_back(-list[i]);
            list.push_back(Limits::quiet_NaN());
            return list;
        }();
        return numbers;
    }

   private:
    std::mt19937_64 engine_;
};

}  // namespace rt
