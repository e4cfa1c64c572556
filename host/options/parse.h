// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "host/base/text.h"
#include "host/options/command_line.h"
#include "host/options/render_options.h"

namespace rt {

/// Rejects the value of the option being read, or a part of it: throws BadValue.
[[noreturn]] void refuse(const std::string& value, const std::string& reason);

/// The same for a text that is none of the choices; guesses which one was meant.
[[noreturn]] void refuse_choice(const std::string& value, const std::vector<std::string>& choices);

// Readers of an option's value, or makers of such readers; all reject other text.

/// WIDTHxHEIGHT or N; ExitCode::limit for too many pixels.
PictureSize parse_size(const std::string& text);

AaMode parse_aa(const std::string& text);

inline std::string parse_text(const std::string& text) { return text; }

/// A device spec, or several separated by commas: the text, once checked. Throws Error.
std::string parse_device(const std::string& text);

/// A whole number from `least` to `most`.
inline auto count_in(int least, int most) {
    return [least, most](const std::string& text) {
        const auto count = parse_number<int>(text);
        if (!count || *count < least || *count > most) {
            refuse(text, fmt::format("expected a whole number from {} to {}", least, most));
        }
        return *count;
    };
}

/// Seconds from `least` to 1e8.
inline auto seconds_from(double least) {
    return [least](const std::string& text) {
        const auto seconds = parse_number<double>(text);
        if (!seconds || !(*seconds >= least && *seconds <= 1e8)) {
            refuse(text, fmt::format("expected a number of seconds from {:g} to 1e8", least));
        }
        return *seconds;
    };
}

/// "5%" or "5": 0.05.
inline auto percent_to(double most) {
    return [most](const std::string& text) {
        const bool has_sign = text.ends_with('%');
        const auto percent = parse_number<double>(text.substr(0, text.size() - (has_sign ? 1 : 0)));
        if (!percent || !(*percent >= 0 && *percent <= most)) {
            refuse(text, fmt::format("expected a percentage from 0% to {:g}%", most));
        }
        return *percent / 100;
    };
}

/// The parts between commas; rejects an empty part, for this reason.
std::vector<std::string> split_list(
    const std::string& text, const std::string& reason = "expected a list separated by commas");

/// A list separated by commas, each part read by `parse`.
template <typename Parse>
auto list_of(const Parse& parse) {
    return [parse](const std::string& text) {
        std::vector<std::decay_t<decltype(parse(text))>> values;
        for (const std::string& part : split_list(text)) values.push_back(parse(part));
        return values;
    };
}

/// Integers with a separator between them; those too large for int become its largest value, for
/// range checks to reject. Empty for any other text.
std::optional<std::vector<int>> parse_integers(std::string_view text, char separator);

/// The value of an environment variable, or "".
std::string environment(const char* name);

template <typename T, std::size_t n>
std::vector<std::string> names_of(const Named<T> (&choices)[n]) {
    std::vector<std::string> names;
    for (const Named<T>& choice : choices) names.emplace_back(choice.name);
    return names;
}

/// A name from a table, which must outlive the reader.
template <typename T, std::size_t n>
auto one_of(const Named<T> (&choices)[n]) {
    return [&choices](const std::string& text) {
        const std::optional<T> value = value_of(choices, text);
        if (!value) refuse_choice(text, names_of(choices));
        return *value;
    };
}

/// An option that takes a name from a table.
template <typename T, typename N, std::size_t n>
void add_choice(const CommandLine& verb, const std::string& option, T& target,
                const Named<N> (&choices)[n], const std::string& help) {
    verb.value(option, fmt::format("{}", fmt::join(names_of(choices), "|")), target,
               one_of(choices), help);
}

/// The same; without a name, the option means `bare`.
template <typename T, typename N, std::size_t n>
void add_optional_choice(const CommandLine& verb, const std::string& option, T& target,
                         const Named<N> (&choices)[n], const std::string& bare,
                         const std::string& help) {
    verb.optional_value(
        option, fmt::format("{}", fmt::join(names_of(choices), "|")), help, bare,
        [&choices](const std::string& text) { return value_of(choices, text).has_value(); },
        [&target, read = one_of(choices)](const std::string& text) { target = read(text); });
}

}  // namespace rt
