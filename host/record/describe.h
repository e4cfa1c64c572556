// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

// A record's fields are listed once, next to its struct, in a function template
//     template <typename A, Of<Thing> X>
//     void describe(A& a, X& x) {
//         a("width", x.width, "pixels");
//         a.group("image", [&](auto& a) { a("hash", x.hash, "of its bits"); });
//     }
// from which record.h makes and reads JSON and makes rows of CSV, and a test the JSON Schemas in
// docs. A field is a number, a string, a bool, a record, a vector of these, an enum whose names
// enum_names returns (found by argument-dependent lookup), or what the JSON library converts. Empty
// optionals are left out; or_null writes null for them. A temporary is a computed field: it is
// written but not read.
namespace rt {

/// X is T or const T.
template <typename X, typename T>
concept Of = std::same_as<std::remove_const_t<X>, T>;

/// An optional that JSON shows as null when it is empty.
template <typename T>
struct OrNull {
    std::optional<T> value;
};

template <typename T>
OrNull<T> or_null(std::optional<T> value) {
    return {std::move(value)};
}

/// JSON has neither NaN nor infinity.
inline OrNull<double> finite_or_null(double x) {
    return {std::isfinite(x) ? std::optional(x) : std::nullopt};
}

/// Empty for an empty text, which is then left out.
inline std::optional<std::string> unless_empty(const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(text);
}

}  // namespace rt
