// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

namespace rt {

template <typename T>
typename Flat<T>::Tile flat_tile(const Rect& tile, const Rect& region) {
    typename Flat<T>::Tile flat{};
    flat.x = tile.x;
    flat.y = tile.y;
    flat.width = tile.width;
    flat.height = tile.height;
    flat.first = (tile.y - region.y) * region.width + (tile.x - region.x);
    flat.film_width = region.width;
    return flat;
}

template Flat<float>::Tile flat_tile<float>(const Rect&, const Rect&);
template Flat<double>::Tile flat_tile<double>(const Rect&, const Rect&);

}  // namespace rt
