// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/cli/verb_texts.h"

namespace rt {

namespace {

// Each script asks the program what may stand there; for nothing, the shell offers files.

constexpr const char* bash_script = R"sh(_mirrorball() {
    local IFS=$'\n' word words=()
    for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
        [[ $word == = ]] || words+=("$word")  # of --math=strict, bash makes three words
    done
    [[ $word != = ]] || words+=('')
    COMPREPLY=($(command "${COMP_WORDS[0]}" --complete "${words[@]}" 2>/dev/null | cut -f 1))
}
complete -o default -F _mirrorball mirrorball
)sh";

constexpr const char* zsh_script = R"sh(#compdef mirrorball
local -a offered
offered=(${(f)"$(command ${(Q)words[1]} --complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)"})
offered=("${offered[@]//:/\\:}")
offered=("${offered[@]/$'\t'/:}")
if (( $#offered )); then _describe mirrorball offered; else _files; fi
)sh";

constexpr const char* fish_script = R"sh(function __mirrorball
    set -l words (commandline -opc) (commandline -ct)
    set -l offered (command $words[1] --complete $words[2..-1] 2>/dev/null)
    if test -n "$offered"
        printf '%s\n' $offered
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c mirrorball -f -a '(__mirrorball)'
)sh";

/// The words that a type such as "float|double" lists; none for "FILE|-", "WxH|N" and the like.
std::vector<std::string> values_of(const std::string& type) {
    std::vector<std::string> values{""};
    for (const char c : type) {
        if (c == '|') {
            values.emplace_back();
        } else if (c != '[' && c != ']') {
            values.back() += c;
        }
    }
    std::erase(values, "..");  // and so on
    const bool are_words = std::ranges::all_of(values, [](const std::string& value) {
        return !value.empty() &&
               value.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ%,") == std::string::npos;
    });
    return are_words && values.size() > 1 ? values : std::vector<std::string>{};
}

/// The option of that name that takes a value; null if there is none.
const OptionText* option_with_value(const VerbText& verb, const std::string& name) {
    const auto found = std::ranges::find_if(verb.options, [&](const OptionText& option) {
        return !option.type.empty() && std::ranges::find(option.names, name) != option.names.end();
    });
    return found == verb.options.end() ? nullptr : &*found;
}

/// Whether the word is the option's value; a value in brackets may be left out. Not of null.
bool may_take(const OptionText* option, const std::string& word) {
    return option != nullptr && !(option->type.starts_with('[') && word.starts_with('-'));
}

}  // namespace

std::string completions_of(const VerbText& program, std::vector<std::string> words) {
    const std::string last = words.empty() ? "" : words.back();
    if (!words.empty()) words.pop_back();
    const VerbText* verb = &program;
    const OptionText* option = nullptr;  // whose value comes next
    for (const std::string& word : words) {
        option = may_take(option, word) ? nullptr : option_with_value(*verb, word);
        const auto inner = std::ranges::find(verb->verbs, word, &VerbText::name);
        if (inner != verb->verbs.end()) verb = &*inner;
    }
    std::string text;
    const auto offer = [&](const std::string& word, const std::string& help) {
        if (word.starts_with(last)) text += word + "\t" + help + "\n";
    };
    const std::string before = last.substr(0, last.find('=') + 1);
    if (!before.empty()) option = option_with_value(*verb, last.substr(0, last.find('=')));
    if (may_take(option, last.substr(before.size()))) {
        for (const std::string& value : values_of(option->type)) offer(before + value, "");
    } else if (!last.empty() || !verb->verbs.empty()) {
        for (const VerbText& one : verb->verbs) offer(one.name, one.help);
        for (const OptionText& one : verb->options) {
            if (one.is_word) continue;
            for (const std::string& name : one.names) offer(name, one.help);
        }
    }
    return text;
}

std::string completion_script(const std::string& shell) {
    return shell == "bash"   ? bash_script
           : shell == "zsh"  ? zsh_script
           : shell == "fish" ? fish_script
                             : "";
}

}  // namespace rt
