// SPDX-License-Identifier: Apache-2.0
#include "host/render/film.h"

#include <span>

#include "host/hash.h"

namespace rt {

template <typename T>
std::uint64_t hash_of(const Film<T>& film) {
    Hasher hasher;
    hasher.add(film.width);
    hasher.add(film.height);
    hasher.add_bytes(std::as_bytes(std::span(film.rgb)));
    return hasher.value();
}

template std::uint64_t hash_of(const Film<float>&);
template std::uint64_t hash_of(const Film<double>&);

}  // namespace rt
