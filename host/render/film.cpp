// SPDX-License-Identifier: Apache-2.0
#include "host/render/film.h"

#include <algorithm>
#include <span>

#include "host/base/hash.h"

namespace rt {

template <typename T>
Film<T> part_of(const Film<T>& film, const Rect& shown, const Rect& part) {
    Film<T> cut(part.width, part.height);
    const auto row_length = 3 * static_cast<std::ptrdiff_t>(part.width);
    for (int row = 0; row < part.height; ++row) {
        std::copy_n(&film.rgb[3 * index_in(shown, part.x, part.y + row)], row_length,
                    cut.rgb.begin() + row * row_length);
    }
    return cut;
}

template Film<float> part_of(const Film<float>&, const Rect&, const Rect&);
template Film<double> part_of(const Film<double>&, const Rect&, const Rect&);

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
