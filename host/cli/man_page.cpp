// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/cli/command_line.h"

namespace rt {

extern const char* const man_page_template;  // docs/mirrorball.1.in, embedded by CMake

namespace {

/// Text, escaped for roff.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\') {
            escaped += "\\e";
        } else if (c == '-') {
            escaped += "\\-";
        } else if (c == ',') {
            escaped += ",\\:";  // lists may break here
        } else {
            escaped += c;
        }
    }
    return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string option_roff(const Option& option) {
    std::string text = ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i) {
        text += fmt::format("{}\\f{}{}\\fR", i == 0 ? "" : ", ", option.is_word ? 'I' : 'B',
                            roff(option.is_word ? option.word() : option.names[i]));
    }
    if (!option.type.empty()) text += " \\fI" + roff(option.type) + "\\fR";
    return text + "\n" + roff(option.help) + "\n";
}

std::string synopses(const Verb& verb) {
    std::string text;
    for (const Verb& one : verb.verbs) text += synopses(one);
    if (!verb.verbs.empty()) return text;
    text = fmt::format(".B {}\n[\\fIoptions\\fR]", roff(verb.path));
    for (const Option& option : verb.options) {
        if (!option.is_word) continue;
        const std::string word = "\\fI" + roff(option.word()) + "\\fR";
        text += option.is_required ? " " + word : " [" + word + "]";
    }
    return text + "\n.br\n";
}

std::string sections(const Verb& verb) {
    std::string text = fmt::format(".SS {}\n{}\n", roff(verb.path), roff(verb.about));
    for (const Option& option : verb.options) text += option_roff(option);
    for (const Verb& one : verb.verbs) text += sections(one);
    return text;
}

}  // namespace

std::string man_page(const Verb& program, const std::string& version) {
    std::string text = man_page_template;
    const auto fill = [&text](const std::string& mark, const std::string& with) {
        text.replace(text.find(mark), mark.size(), with);
    };
    fill("@VERSION@", roff(version));
    fill("@NAME@", fmt::format("{} \\- {}", roff(program.path), roff(program.about)));
    fill("@SYNOPSIS@\n", synopses(program));
    fill("@OPTIONS@\n", sections(program));
    return text;
}

}  // namespace rt
