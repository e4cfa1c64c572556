// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/base/text.h"

namespace rt {

/// How many rounds the rows have: "4 rounds after a warm-up", or with an interrupt
/// "1 of 4 rounds after a warm-up, interrupted".
template <typename Row>
std::string rounds_text(const std::vector<Row>& rows, int asked, bool interrupted) {
    std::size_t done = 0;
    for (const Row& row : rows) done = std::max(done, row.repeats.size());
    const std::string rounds = counted(static_cast<std::size_t>(asked), "round");
    return interrupted ? fmt::format("{} of {} after a warm-up, interrupted", done, rounds)
                       : rounds + " after a warm-up";
}

}  // namespace rt
