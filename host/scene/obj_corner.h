// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace rt {

/// "1", "1/2", "1//3" or "1/2/3" as the file says it, or with nothing after a slash: "1/", "1//",
/// "1/2/". 0 means no number: OBJ indices are never 0.
struct ObjCorner {
    std::int64_t position = 0, texture = 0, normal = 0;
    bool has_normal = false;
};

std::optional<ObjCorner> parse_obj_corner(std::string_view text);

/// A fast path for the corner at the start of a line, if it consists of short positive numbers, as
/// nearly all do: returns its length, or 0 where parse_obj_corner must parse it.
std::size_t parse_plain_obj_corner(std::string_view line, ObjCorner& corner);

}  // namespace rt
