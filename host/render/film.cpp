// SPDX-License-Identifier: Apache-2.0
#include "host/render/film.h"

#include <cmath>
#include <span>

#include "host/hash.h"

namespace rt {

template <typename T>
std::size_t count_non_finite(const Film<T>& film) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < film.rgb.size(); i += 3) {
        const bool finite = std::isfinite(film.rgb[i]) && std::isfinite(film.rgb[i + 1]) &&
                            std::isfinite(film.rgb[i + 2]);
        count += finite ? 0 : 1;
    }
    return count;
}

template <typename T>
std::uint64_t hash_of(const Film<T>& film) {
    Hasher hasher;
    hasher.add(film.width);
    hasher.add(film.height);
    hasher.add_bytes(std::as_bytes(std::span(film.rgb)));
    return hasher.value();
}

template std::size_t count_non_finite(const Film<float>&);
template std::size_t count_non_finite(const Film<double>&);
template std::uint64_t hash_of(const Film<float>&);
template std::uint64_t hash_of(const Film<double>&);

}  // namespace rt
