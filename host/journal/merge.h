// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/journal/journal_format.h"
#include "host/journal/shares.h"

namespace rt {

/// The parts of one picture, put together.
struct MergedPicture {
    JournalHeader header;  ///< of the first part
    Picture picture;       ///< black where a part is missing
    std::uint64_t image_hash = 0;
    std::size_t missing_pixels = 0;
    std::optional<Shares> missing;   ///< the shares to render again, of as many as the first part's
    std::vector<std::string> notes;  ///< about parts that are not whole
};

/// Puts parts together, in any order. Pixels that several have must be the same in each. Throws
/// Error: input for what is no journal or is of another picture than the first; different, with
/// files, hosts and devices, where parts differ; limit.
MergedPicture merge_journals(const std::vector<std::string>& parts);

}  // namespace rt
