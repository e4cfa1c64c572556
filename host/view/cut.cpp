// SPDX-License-Identifier: Apache-2.0
#include "host/view/cut.h"

#include <cstddef>

namespace rt {

Picture cut(const Picture& picture, const Rect& part) {
    Picture result{part.width, part.height, 3, {}};
    const auto row = 3 * static_cast<std::ptrdiff_t>(part.width);
    for (int y = part.y; y < part.y + part.height; ++y) {
        const auto from = picture.pixels.begin() + 3 * (std::ptrdiff_t{y} * picture.width + part.x);
        result.pixels.insert(result.pixels.end(), from, from + row);
    }
    return result;
}

}  // namespace rt
