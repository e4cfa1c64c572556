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

/// The same for a name that is none of the choices: lists them, and says which may be meant.
[[noreturn]] void refuse_choice(const std::string& option, const std::string& value,
                                const std::vector<std::string>& choices);

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

/// An option that names a file, folder or scene: any text but an empty one, which a script whose
/// variable is unset gives.
void add_name(const CommandLine& verb, const std::string& option, const std::string& type,
              std::string& name, const std::string& help);

template <typename E>
struct Choice {
    const char* name;
    E value;
};

/// An option that takes one of several names.
template <typename E>
void add_choice(const CommandLine& verb, const std::string& option, E& value,
                const std::vector<Choice<E>>& choices, const std::string& help) {
    std::string type;
    std::vector<std::string> names;
    for (const Choice<E>& choice : choices) {
        type += (type.empty() ? "" : "|") + std::string(choice.name);
        names.emplace_back(choice.name);
    }
    const auto read = [&value, choices, option, names](const std::string& text) {
        for (const Choice<E>& choice : choices) {
            if (text == choice.name) {
                value = choice.value;
                return;
            }
        }
        refuse_choice(option, text, names);
    };
    verb.option(option, type, help, read);
}

}  // namespace rt
