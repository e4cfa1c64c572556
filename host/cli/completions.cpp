// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/base/text.h"
#include "host/cli/command_line.h"

namespace rt {

// contrib/completions, embedded by CMake: each asks the program what may stand there; for nothing,
// the shell offers files.
extern const char *const bash_completions, *const zsh_completions, *const fish_completions;

namespace {

/// The words that a type such as "float|double" lists; none for "FILE|-", "WxH|N" and the like.
std::vector<std::string> values_of(const std::string& type) {
    std::string words = type;
    std::erase_if(words, [](char c) { return c == '[' || c == ']'; });
    std::vector<std::string> values = split(words, '|');
    std::erase(values, "..");  // and so on
    const bool are_words = std::ranges::all_of(values, [](const std::string& value) {
        return !value.empty() &&
               value.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ%,") == std::string::npos;
    });
    return are_words && values.size() > 1 ? values : std::vector<std::string>{};
}

/// The option of that name that takes a value; null if there is none.
const Option* option_with_value(Verb& verb, const std::string& name) {
    const Option* const option = verb.find(name);
    return option != nullptr && !option->type.empty() ? option : nullptr;
}

}  // namespace

std::string completions_of(Verb& program, std::vector<std::string> words) {
    const std::string last = words.empty() ? "" : words.back();
    if (!words.empty()) words.pop_back();
    Verb* verb = &program;
    for (const std::string& word : words) {
        const auto inner = std::ranges::find(verb->verbs, word, &Verb::name);
        if (inner != verb->verbs.end()) verb = &*inner;
    }
    std::string text;
    const auto offer = [&](const std::string& word, const std::string& help) {
        if (word.starts_with(last)) text += word + "\t" + help + "\n";
    };
    const std::string before = last.substr(0, last.find('=') + 1);  // "--math="
    if (!before.empty()) words.push_back(last.substr(0, before.size() - 1));
    const Option* const option = words.empty() ? nullptr : option_with_value(*verb, words.back());
    if (option != nullptr && (!before.empty() || !last.starts_with('-'))) {
        for (const std::string& value : values_of(option->type)) offer(before + value, "");
    } else if (!last.empty() || !verb->verbs.empty()) {
        for (const Verb& one : verb->verbs) offer(one.name(), one.about);
        for (const Option& one : verb->options) {
            if (one.is_word) continue;
            for (const std::string& name : one.names) offer(name, one.help);
        }
    }
    return text;
}

std::string completion_script(const std::string& shell) {
    if (shell == "bash") return bash_completions;
    if (shell == "zsh") return zsh_completions;
    if (shell == "fish") return fish_completions;
    throw BadValue{shell, "expected bash, zsh or fish"};
}

}  // namespace rt
