// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_corner.h"

#include <charconv>

namespace rt {
namespace {

/// Reads one number up to a slash or the end; returns whether it is valid.
bool take_index(std::string_view& text, std::int64_t& index) {
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, index);
    if (result.ec != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return text.empty() || text[0] == '/';
}

/// Reads up to 9 digits.
std::int64_t take_digits(const char*& at, const char* end) {
    const char* const stop = end - at > 9 ? at + 9 : end;
    std::int64_t number = 0;
    for (; at != stop && *at >= '0' && *at <= '9'; ++at) number = 10 * number + (*at - '0');
    return number;
}

bool take_slash(const char*& at, const char* end) {
    if (at == end || *at != '/') return false;
    ++at;
    return true;
}

}  // namespace

std::size_t parse_plain_obj_corner(std::string_view line, ObjCorner& corner) {
    const char* at = line.data();
    const char* const end = at + line.size();
    corner = {take_digits(at, end), 0, 0, false};
    if (corner.position != 0 && take_slash(at, end)) {
        corner.texture = take_digits(at, end);
        corner.has_normal = take_slash(at, end);
        if (corner.has_normal) corner.normal = take_digits(at, end);
    }
    const bool ended = at != end && (*at == ' ' || *at == '\n') && at[-1] != '/';
    return ended && corner.position != 0 ? static_cast<std::size_t>(at - line.data()) : 0;
}

std::optional<ObjCorner> parse_obj_corner(std::string_view text) {
    ObjCorner corner;
    if (!take_index(text, corner.position)) return std::nullopt;
    if (text.empty()) return corner;
    text.remove_prefix(1);
    const bool textured = !text.empty() && text[0] != '/';
    if (textured && !take_index(text, corner.texture)) return std::nullopt;
    if (text.empty()) return corner;
    text.remove_prefix(1);
    corner.has_normal = !text.empty();
    if (text.empty()) return corner;
    if (!take_index(text, corner.normal) || !text.empty()) return std::nullopt;
    return corner;
}

}  // namespace rt
