// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace rt {

/// Asks for huge pages for memory that is not touched yet, if there is enough of it; has no effect
/// on systems without them.
void advise_huge_pages(void* memory, std::size_t bytes);

/// Grows a vector that will be filled, on huge pages: with small pages most of the fill cost is
/// page faults, and incoherent rays suffer TLB misses.
template <typename Item>
void resize_huge(std::vector<Item>& items, std::size_t count) {
    items.reserve(count);
    advise_huge_pages(items.data() + items.size(), (count - items.size()) * sizeof(Item));
    items.resize(count);
}

}  // namespace rt
