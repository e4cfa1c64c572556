// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace rt {

/// Asks for large pages under memory that is not touched yet, if there is enough of it; a system
/// without them is asked in vain.
void advise_huge_pages(void* memory, std::size_t bytes);

/// Grows a vector that will be used to its end: on large pages, since most of what filling many
/// small ones costs is the system's work, and rays that jump about in them wait for their tables.
template <typename Item>
void resize_huge(std::vector<Item>& items, std::size_t count) {
    items.reserve(count);
    advise_huge_pages(items.data() + items.size(), (count - items.size()) * sizeof(Item));
    items.resize(count);
}

}  // namespace rt
