// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "host/parallel.h"

namespace rt {

/// How a large file is read: by so many threads, in chunks of about so many bytes. Neither changes
/// what is read, or which mistakes are found.
struct ReadPace {
    int threads = available_cores();
    std::size_t chunk_bytes = std::size_t{1} << 20;
};

/// Offsets at which a text of lines may be cut, 0 and its end among them: after a line feed that no
/// backslash joins to the next line.
std::vector<std::size_t> line_cuts(std::string_view text, std::size_t chunk_bytes);

}  // namespace rt
