// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace rt {

/// The number that the whole text is, if it is one that N can hold.
template <typename N>
std::optional<N> parse_number(std::string_view text) {
    N number{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stop != end) return std::nullopt;
    return number;
}

/// The parts between separators; all of the text if there is none.
std::vector<std::string> split(std::string_view text, char separator);

/// The value of an environment variable, or "".
std::string environment(const char* name);

/// The text with the letters of ASCII in lower case.
inline std::string lower(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

/// The text before its first line break.
inline std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// ".nff" of "a/b.NFF".
inline std::string lower_extension(const std::string& path) {
    return lower(std::filesystem::path(path).extension().string());
}

/// "1 sphere", "0 lights"; with a plural of its own, "1 pixel is", "2 pixels are".
template <std::integral N>
std::string counted(N count, const std::string& noun, const std::string& plural = "") {
    return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

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

/// A cell of a CSV table (RFC 4180): in quotes if it holds a comma, a quote or a line break.
std::string csv_quoted(const std::string& text);

/// The byte order mark that some editors put at the start of a UTF-8 file.
inline constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

/// Continuation bytes belong to the character before them and take no column of their own.
constexpr bool is_utf8_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

/// Bytes of the text's first character if it is safe to show, else 0: control characters (C0, C1),
/// invalid UTF-8, line separators, and characters that are invisible or change the writing
/// direction.
std::size_t printable_length(std::string_view text);

/// Makes untrusted text, such as a file or device name, safe for messages and tables: each
/// unprintable byte becomes "\xNN". It cannot break a line or send the terminal escape sequences.
std::string printable(std::string_view text);

/// The name of an OpenCL device, for tables of text: PoCL calls its own "pthread-haswell-AMD EPYC",
/// which is "PoCL" here. Other names stay.
std::string short_device_name(const std::string& name);

}  // namespace rt
