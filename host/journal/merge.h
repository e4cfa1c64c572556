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

/// A picture merged from its parts.
struct MergedPicture {
    JournalHeader header;  ///< of the first part
    Picture picture;       ///< black where a part is missing
    std::uint64_t image_hash = 0;
    std::size_t missing_pixels = 0;
    std::optional<Shares> missing;   ///< the shares to render again, numbered as in the first part
    std::vector<std::string> notes;  ///< about incomplete parts
};

/// Merges parts in any order. Pixels present in several parts must be equal. Those without a
/// complete header are ignored, with a note. Throws Error: input for a part that is no journal or
/// belongs to another picture than the first; different, with files, hosts and devices, where parts
/// differ; limit.
MergedPicture merge_journals(const std::vector<std::string>& parts);

}  // namespace rt
