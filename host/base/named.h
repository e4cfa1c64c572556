// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rt {

/// A value and its name on the command line and in files. Tables of these stand next to their enum.
template <typename T>
struct Named {
    const char* name;
    T value;
};

template <typename T, std::size_t n>
const char* name_of(const Named<T> (&table)[n], const T& value) {
    for (const Named<T>& one : table) {
        if (one.value == value) return one.name;
    }
    return "";
}

template <typename T, std::size_t n>
std::optional<T> value_of(const Named<T> (&table)[n], std::string_view name) {
    for (const Named<T>& one : table) {
        if (name == one.name) return one.value;
    }
    return std::nullopt;
}

inline const char* precision_name(bool is_double) { return is_double ? "double" : "float"; }

inline const char* math_name(bool is_fast) { return is_fast ? "fast" : "strict"; }

}  // namespace rt
