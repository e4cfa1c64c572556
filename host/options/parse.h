// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/options/command_line.h"
#include "host/options/render_options.h"

namespace rt {

/// Throws Error (ExitCode::usage): "option 'value': expected".
[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& expected);

/// Integers with a separator between them; those too large for int become its largest value, for
/// range checks to reject. Empty for any other text.
std::optional<std::vector<int>> parse_integers(std::string_view text, char separator);

/// WIDTHxHEIGHT or N. Throws Error: ExitCode::usage, or ExitCode::limit for too many pixels.
PictureSize parse_size(const std::string& option, const std::string& text);

/// Numbers from 0 to 1e30, separated by commas; empty for any other text.
std::optional<std::vector<double>> parse_amounts(std::string_view text);

/// Seconds from `least` to 1e8. Throws Error (ExitCode::usage).
double parse_seconds(const std::string& option, const std::string& text, double least);

/// "5%" or "5": 0.05. Throws Error (ExitCode::usage) outside 0 to `most` percent.
double parse_percent(const std::string& option, const std::string& text, double most);

/// The value of an environment variable, or "".
std::string environment(const char* name);

template <typename E>
struct Choice {
    const char* name;
    E value;
};

/// An option that takes one of several names.
template <typename E>
void add_choice(const CommandLine& verb, const std::string& option, E& value,
                const std::vector<Choice<E>>& choices, const std::string& help) {
    std::string names;
    for (const Choice<E>& choice : choices) {
        names += (names.empty() ? "" : "|") + std::string(choice.name);
    }
    const auto read = [&value, choices, option, names](const std::string& text) {
        for (const Choice<E>& choice : choices) {
            if (text == choice.name) {
                value = choice.value;
                return;
            }
        }
        refuse(option, text, "give one of " + names);
    };
    verb.option(option, names, help, read);
}

}  // namespace rt
