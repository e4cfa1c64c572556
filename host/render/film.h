// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/base/hash.h"
#include "host/base/memory.h"
#include "host/render/rect.h"

namespace rt {

/// The rendered picture in linear light, unclamped: three numbers per pixel, row 0 at the top.
template <typename T>
struct Film {
    Film(int film_width, int film_height) : width(film_width), height(film_height) {
        const auto count =
            3 * static_cast<std::size_t>(film_width) * static_cast<std::size_t>(film_height);
        rgb.reserve(count);  // with small pages, most of the time to fill it goes to page faults
        advise_huge_pages(rgb.data(), count * sizeof(T));
        rgb.resize(count);
    }

    int width, height;  ///< pixels
    std::vector<T> rgb;
};

/// The numbers as a picture has them.
template <typename T>
std::vector<float> as_floats(Film<T>&& film) {
    if constexpr (std::is_same_v<T, float>) return std::move(film.rgb);
    return {film.rgb.begin(), film.rgb.end()};
}

/// Crops a film that shows `shown` to `part`, which lies in it.
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

/// 64 bits over size and every bit of the film (FNV-1a): equal hashes, equal pictures.
template <typename T>
std::uint64_t hash_of(const Film<T>& film) {
    Hasher hasher;
    hasher.add(film.width);
    hasher.add(film.height);
    hasher.add_bytes(std::as_bytes(std::span(film.rgb)));
    return hasher.value();
}

}  // namespace rt
