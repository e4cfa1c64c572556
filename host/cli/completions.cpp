// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "host/cli/verb_texts.h"

namespace rt {

namespace {

/// The words that a type such as "float|double" lists; none for "FILE|-", "WxH|N" and the like.
std::vector<std::string> values_of(const std::string& type) {
    std::vector<std::string> values{""};
    for (const char c : type) {
        if (c == '[' || c == ']') continue;
        if (c == '|') {
            values.emplace_back();
        } else {
            values.back() += c;
        }
    }
    std::erase(values, "..");  // and so on
    const bool are_words = std::all_of(values.begin(), values.end(), [](const std::string& value) {
        return !value.empty() && std::none_of(value.begin(), value.end(), [](char c) {
            return std::isupper(static_cast<unsigned char>(c)) != 0 || c == '%' || c == ',';
        });
    });
    return are_words && values.size() > 1 ? values : std::vector<std::string>{};
}

std::vector<std::string> names_of(const std::vector<VerbText>& verbs) {
    std::vector<std::string> names;
    for (const VerbText& verb : verbs) names.push_back(verb.name);
    return names;
}

/// How a shell's `case` names the words typed for a verb; the program's own, for all other words.
std::string typed_words(const std::string& words) {
    return words.empty() ? "*" : fmt::format("'{} '*", words);
}

/// A branch for each verb, by the words that choose it: "render", "scene info".
std::string bash_branches(const VerbText& verb, const std::string& words) {
    std::string text;
    for (const VerbText& one : verb.verbs) {
        text += bash_branches(one, words.empty() ? one.name : words + " " + one.name);
    }
    std::vector<std::string> offered = names_of(verb.verbs), with_files;
    std::string values;
    for (const OptionText& option : verb.options) {
        if (option.is_word) continue;
        offered.insert(offered.end(), option.names.begin(), option.names.end());
        if (const auto choices = values_of(option.type); !choices.empty()) {
            values += fmt::format("                {}) words='{}' ;;\n",
                                  fmt::join(option.names, "|"), fmt::join(choices, " "));
        } else if (!option.type.empty()) {
            with_files.insert(with_files.end(), option.names.begin(), option.names.end());
        }
    }
    if (!with_files.empty()) {
        values += fmt::format("                {}) words= ;;\n", fmt::join(with_files, "|"));
    }
    return text + fmt::format(
                      "        {})\n            words='{}'\n            case $before in\n"
                      "{}            esac ;;\n",
                      typed_words(words), fmt::join(offered, " "), values);
}

std::string bash_completions(const VerbText& program) {
    return fmt::format(
        "_{0}() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=\n"
        "    [[ $word != = ]] || word=  # of --math=strict, bash makes three words\n"
        "    [[ $before != = ]] || before=${{COMP_WORDS[COMP_CWORD-2]}}\n"
        "    case \"${{COMP_WORDS[*]:1:COMP_CWORD-1}} \" in\n"
        "{1}"
        "    esac\n"
        "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "}}\n"
        "complete -o default -F _{0} {0}\n",
        program.name, bash_branches(program, ""));
}

/// Text between single quotes, where colons and brackets have a meaning.
std::string zsh_text(const std::string& text) {
    std::string quoted;
    for (const char c : text) {
        if (c == ':' || c == '[' || c == ']' || c == '\\') quoted += '\\';
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return quoted;
}

/// What zsh's _arguments takes for an option.
std::string zsh_option(const std::string& name, const OptionText& option) {
    std::string text = "        '" + name;
    if (!option.type.empty() && name.starts_with("--")) text += "=";
    text += "[" + zsh_text(option.help) + "]";
    if (option.type.empty()) return text + "'\n";
    const auto values = values_of(option.type);
    text += option.type.starts_with('[') ? "::value:" : ":value:";
    text += values.empty() ? "_files" : fmt::format("({})", fmt::join(values, " "));
    return text + "'\n";
}

/// A branch for each verb, as in bash.
std::string zsh_branches(const VerbText& verb, const std::string& words) {
    std::string text, offered, verbs;
    for (const VerbText& one : verb.verbs) {
        text += zsh_branches(one, words.empty() ? one.name : words + " " + one.name);
        verbs += fmt::format(" '{}:{}'", one.name, zsh_text(one.help));
    }
    bool takes_files = false;
    for (const OptionText& option : verb.options) {
        takes_files |= option.is_word;
        if (option.is_word) continue;
        for (const std::string& name : option.names) offered += zsh_option(name, option);
    }
    if (takes_files) offered += "        '*:file:_files'\n";
    if (!verbs.empty()) offered += "        '*:verb:{_describe verb verbs}'\n";
    return text + fmt::format("    {})\n        verbs=({})\n        own=(\n{}        ) ;;\n",
                              typed_words(words), verbs, offered);
}

/// The body of a function, which compinit finds by its first line.
std::string zsh_completions(const VerbText& program) {
    return fmt::format(
        "#compdef {}\nlocal -a verbs own\ncase \"${{words[2,CURRENT-1]}} \" in\n{}esac\n"
        "_arguments \"${{own[@]}}\"\n",
        program.name, zsh_branches(program, ""));
}

std::string in_quotes(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? "\\'" : std::string(1, c);
    return quoted + "'";
}

std::string fish_lines(const VerbText& verb, const std::string& program,
                       const std::string& condition) {
    std::string text;
    const std::string head = fmt::format("complete -c {} -n {}", program, in_quotes(condition));
    for (const OptionText& option : verb.options) {
        if (option.is_word) continue;
        text += head;
        for (const std::string& name : option.names) {
            text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
        const auto values = values_of(option.type);
        if (!values.empty()) text += fmt::format(" -x -a '{}'", fmt::join(values, " "));
        if (values.empty() && !option.type.empty()) text += " -r";
        text += " -d " + in_quotes(option.help) + "\n";
    }
    for (const VerbText& one : verb.verbs) {
        const std::string none = "not __fish_seen_subcommand_from " +
                                 fmt::format("{}", fmt::join(names_of(verb.verbs), " "));
        const bool is_first = condition == "__fish_use_subcommand";
        text += fmt::format("complete -c {} -f -n {} -a {} -d {}\n", program,
                            in_quotes(is_first ? condition : condition + "; and " + none), one.name,
                            in_quotes(one.help));
        const std::string seen = "__fish_seen_subcommand_from " + one.name;
        text += fish_lines(one, program, is_first ? seen : condition + "; and " + seen);
    }
    return text;
}

}  // namespace

std::string completions(const VerbText& program, const std::string& shell) {
    if (shell == "bash") return bash_completions(program);
    if (shell == "zsh") return zsh_completions(program);
    if (shell == "fish") return fish_lines(program, program.name, "__fish_use_subcommand");
    return "";
}

}  // namespace rt
