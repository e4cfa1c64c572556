// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rt {

/// A rectangle of picture pixels; rows counted from the top.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;

    std::int64_t pixels() const { return std::int64_t{width} * height; }
    bool operator==(const Rect&) const = default;
};

/// Whether `part` holds a pixel, and only pixels of `whole`; safe for any numbers in `part`.
inline bool is_within(const Rect& part, const Rect& whole) {
    return part.width > 0 && part.height > 0 && part.x >= whole.x && part.y >= whole.y &&
           part.width <= whole.width && part.height <= whole.height &&
           part.x - whole.x <= whole.width - part.width &&
           part.y - whole.y <= whole.height - part.height;
}

/// Where a pixel of the picture is in a film that shows `film`, row by row.
inline std::size_t index_in(const Rect& film, int x, int y) {
    return static_cast<std::size_t>(y - film.y) * static_cast<std::size_t>(film.width) +
           static_cast<std::size_t>(x - film.x);
}

/// [x, y, width, height]
template <typename Json>
void to_json(Json& json, const Rect& rect) {
    json = Json::array({rect.x, rect.y, rect.width, rect.height});
}
template <typename Json>
void from_json(const Json& json, Rect& rect) {
    std::array<int, 4> n;
    json.get_to(n);
    rect = {n[0], n[1], n[2], n[3]};
}

}  // namespace rt
