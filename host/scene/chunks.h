// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "host/base/parallel.h"

namespace rt {

/// How a large file is read: with how many threads, in chunks of about how many bytes. Neither
/// affects the result or the mistakes found.
struct ReadPace {
    int threads = available_cores();
    std::size_t chunk_bytes = std::size_t{1} << 20;
};

/// Offsets at which a text of lines may be split, including 0 and its end: after a line feed that
/// is not escaped by a backslash.
std::vector<std::size_t> line_cuts(std::string_view text, std::size_t chunk_bytes);

}  // namespace rt
