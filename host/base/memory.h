// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace rt {

/// Asks for huge pages for memory that is not touched yet, if there is enough of it; has no effect
/// on systems without them.
void advise_huge_pages(void* memory, std::size_t bytes);

/// Asks for huge pages, and leaves what `resize` adds uninitialized.
template <typename Item>
struct HugeAllocator {
    using value_type = Item;

    HugeAllocator() = default;
    template <typename Other>
    HugeAllocator(const HugeAllocator<Other>&) {}

    Item* allocate(std::size_t count) {
        Item* items = std::allocator<Item>().allocate(count);
        advise_huge_pages(items, count * sizeof(Item));
        return items;
    }
    void deallocate(Item* items, std::size_t count) {
        std::allocator<Item>().deallocate(items, count);
    }
    template <typename Other>
    void construct(Other* item) {
        ::new (static_cast<void*>(item)) Other;
    }
    bool operator==(const HugeAllocator&) const = default;
};

/// A vector on huge pages for threads to fill after `resize`: the pages are first touched, and
/// cleared by the system, on all of them.
template <typename Item>
using HugeVector = std::vector<Item, HugeAllocator<Item>>;

/// How much memory this process may still allocate, and which limit applies.
struct FreeMemory {
    std::uint64_t bytes = 0;
    std::string reason;  ///< "are free", "are left of the container's limit", ...
};

/// The smallest of: the machine's free memory, what each control group of this process leaves
/// (cgroup v2: containers, batch jobs, systemd), and its address space (ulimit -v). `root` is
/// where /proc and /sys are, for tests.
FreeMemory free_memory(const std::string& root = "");

/// Throws Error (ExitCode::limit) when `bytes` more would exceed the free memory of this process:
/// otherwise the system would kill it only after minutes of work. `what` and `advice` go into the
/// message.
void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice);

}  // namespace rt
