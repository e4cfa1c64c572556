// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "host/parallel.h"

namespace rt {

/// Calls body(i) for each i below count, on all cores, in chunks of `run`.
template <typename Body>
void parallel_for(std::size_t count, std::size_t run, const Body& body) {
    std::atomic<std::size_t> next = 0;
    run_on_threads(available_cores(), [&](int) {
        for (std::size_t at = next.fetch_add(run); at < count; at = next.fetch_add(run)) {
            const std::size_t end = std::min(at + run, count);
            for (std::size_t i = at; i < end; ++i) body(i);
        }
    });
}

}  // namespace rt
