// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "host/scene/mistakes.h"

namespace rt {

struct JsonMember;

/// One value of a JSON text and its offset there (Mistakes converts it to line and column).
/// std::monostate is null.
struct JsonValue {
    using Array = std::vector<JsonValue>;
    using Object = std::vector<JsonMember>;

    std::variant<std::monostate, bool, double, std::string, Array, Object> data;
    std::uint32_t offset = 0;

    template <class T>
    const T* as() const {
        return std::get_if<T>(&data);
    }
};

/// Members keep the order of the file.
struct JsonMember {
    std::string key;
    std::uint32_t key_offset = 0;
    JsonValue value;
};

inline constexpr std::size_t max_json_bytes = std::size_t{256} << 20;
inline constexpr std::size_t max_json_values = std::size_t{1} << 25;
inline constexpr std::size_t max_json_depth = 64;

/// Parses a JSON text (RFC 8259, with // and /* */ comments; skips a byte order mark). Notes
/// repeated keys in `mistakes`; a syntax error is thrown along with earlier mistakes. All numbers
/// are doubles; refuses overflow. Throws Error with ExitCode::limit for a
/// text beyond the sizes above.
JsonValue parse_json(Mistakes& mistakes);

/// The kind of a value, for messages: "a number", "an array".
std::string_view kind_of(const JsonValue& value);

}  // namespace rt
