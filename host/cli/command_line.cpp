// SPDX-License-Identifier: Apache-2.0
#include "host/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "host/base/console.h"
#include "host/base/text.h"
#include "host/scene/words.h"

namespace rt {

namespace {

constexpr std::size_t help_width = 80, help_indent = 26;

/// The text in lines that end by column 80, all but the first indented; the first begins at column
/// `at`.
std::string wrapped(const std::string& text, std::size_t at) {
    std::string lines = at > help_indent - 2 ? "\n" + std::string(help_indent, ' ')
                                             : std::string(help_indent - at, ' ');
    std::size_t column = help_indent;
    std::istringstream words(text);
    for (std::string word; words >> word; column += word.size() + 1) {
        if (column > help_indent && column + word.size() > help_width) {
            lines.back() = '\n';
            lines += std::string(help_indent, ' ');
            column = help_indent;
        }
        lines += word + " ";
    }
    lines.back() = '\n';
    return lines;
}

std::string help_entry(const std::string& head, const std::string& help) {
    return "  " + head + wrapped(help, head.size() + 2);
}

/// The help on the program or a verb: its options by group, in their order.
std::string help_text(const Verb& verb) {
    std::vector<std::pair<std::string, std::string>> groups;
    std::string words, verbs, usage;
    for (const Option& option : verb.options) {
        if (option.is_word) {
            words += help_entry(option.names.front(), option.help);
            usage += option.is_required ? " " + option.word() : " [" + option.word() + "]";
            continue;
        }
        auto at =
            std::ranges::find(groups, option.group, &std::pair<std::string, std::string>::first);
        if (at == groups.end()) at = groups.insert(at, {option.group, ""});
        at->second += help_entry(fmt::format("{}{}{}", fmt::join(option.names, ","),
                                             option.type.empty() ? "" : " ", option.type),
                                 option.help);
    }
    for (const Verb& one : verb.verbs) verbs += help_entry(one.name(), one.about);
    std::string text =
        fmt::format("Usage: {}{}{}{}\n{}\n", verb.path, groups.empty() ? "" : " [OPTIONS]",
                    verbs.empty() ? "" : " VERB", usage, verb.about);
    if (!words.empty()) text += "\n" + words;
    if (!verbs.empty()) text += "\nVerbs (mirrorball help VERB tells more):\n" + verbs;
    for (const auto& [group, entries] : groups) text += fmt::format("\n{}:\n{}", group, entries);
    return text;
}

/// Reads the words of a command line, from left to right.
class Reader {
   public:
    Reader(Verb& program, std::vector<std::string> words)
        : verb_(&program), words_(std::move(words)) {}

    /// Returns the verb, or nested verb, that was chosen.
    Verb& read() {
        choose_verb();
        bool only_arguments = false;
        while (at_ < words_.size()) {
            const std::string word = words_[at_++];
            if (only_arguments || !word.starts_with('-') || word == "-") {
                read_argument(word);
            } else if (word == "--") {
                only_arguments = true;
            } else if (word.starts_with("--")) {
                read_long(word);
            } else {
                read_short(word);
            }
        }
        return *verb_;
    }

    /// Rejects a line that lacks something.
    void check() const {
        if (!verb_->verbs.empty()) refuse_line("a verb is required");
        for (const Option& option : verb_->options) {
            if (option.is_required && option.given == 0) {
                refuse_line(option.names.back() + " is required");
            }
        }
    }

   private:
    [[noreturn]] void refuse_line(const std::string& what) const {
        usage_error("{}{} '{} --help'", what, what.ends_with("?") ? " See" : "; see", verb_->path);
    }

    void choose_verb() {
        for (; at_ < words_.size() && !words_[at_].starts_with('-'); ++at_) {
            if (verb_->verbs.empty()) return;
            const std::string& name = words_[at_];
            const auto inner = std::ranges::find(verb_->verbs, name, &Verb::name);
            if (inner == verb_->verbs.end()) {
                std::vector<std::string> names;
                for (const Verb& one : verb_->verbs) names.push_back(one.name());
                refuse_line(fmt::format("unknown verb '{}'; available: {}{}", name,
                                        fmt::join(names, ", "), guess_text(name, names)));
            }
            verb_ = &*inner;
        }
    }

    Option& find(const std::string& name) const {
        if (Option* const option = verb_->find(name)) return *option;
        std::vector<std::string> names;
        for (const Option& option : verb_->options) names.push_back(option.names.back());
        refuse_line(fmt::format("unknown option '{}'{}", name, guess_text(name, names)));
    }

    void take(Option& option, const std::string& value) const {
        if (option.given++ > 0 && !option.may_repeat) {
            refuse_line(option.names.back() + " is given twice");
        }
        try {
            option.take(value);
        } catch (const BadValue& bad) {
            throw Error(bad.exit_code, fmt::format("{} '{}': {}", option.names.front(),
                                                   printable(bad.value), bad.reason));
        }
    }

    void read_argument(const std::string& word) const {
        const auto is_free = [](const Option& option) {
            return option.is_word && (option.may_repeat || option.given == 0);
        };
        const auto argument = std::ranges::find_if(verb_->options, is_free);
        if (argument == verb_->options.end()) refuse_line("unexpected argument '" + word + "'");
        take(*argument, word);
    }

    /// --name, --name VALUE or --name=VALUE
    void read_long(const std::string& word) {
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        Option& option = find(name);
        if (equals == word.npos) return read_value(option);
        if (option.type.empty()) refuse_line("'" + name + "' takes no value");
        if (equals + 1 == word.size()) refuse_line("'" + word + "' has no value");
        take(option, word.substr(equals + 1));
    }

    /// -o VALUE, -oVALUE, or several flags: -qv
    void read_short(const std::string& word) {
        Option& option = find(word.substr(0, 2));
        const std::string rest = word.substr(2);
        if (rest.empty()) return read_value(option);
        if (rest.starts_with('=')) refuse_line("'" + word + "' has an '=' too many");
        if (!option.type.empty()) return take(option, rest);
        take(option, "");
        read_short("-" + rest);
    }

    /// Takes the next word as the option's value, unless it needs none.
    void read_value(Option& option) {
        if (option.type.empty()) return take(option, "");
        const bool is_last = at_ == words_.size();
        if (option.accepts && (is_last || !option.accepts(words_[at_]))) {
            return take(option, option.bare);
        }
        if (is_last) refuse_line(option.names.back() + " requires a value");
        take(option, words_[at_++]);
    }

    Verb* verb_;
    std::vector<std::string> words_;
    std::size_t at_ = 0;
};

}  // namespace

Verb::Verb(const std::string& whole, const std::string& help) : path(whole), about(help) {
    flag("-h,--help", wants_help, "Print this help message and exit");
}

Option& Verb::option(const std::string& names, const std::string& type, const std::string& help,
                     const TakeText& take, bool required) {
    Option& option = options.emplace_back();
    option.names = split(names, ',');
    option.type = type;
    option.help = help;
    option.group = group;
    option.take = take;
    option.is_required = required;
    return option;
}

void Verb::value(const std::string& names, const std::string& type, std::string& target,
                 const std::string& help) {
    option(names, type, help, [&target](const std::string& text) {
        if (text.empty()) throw BadValue{text, "expected a name"};
        target = text;
    });
}

void Verb::optional_value(const std::string& name, const std::string& type, const std::string& help,
                          const std::string& bare, const AcceptsText& accepts,
                          const TakeText& take) {
    Option& added = option(name, "[" + type + "]", help, take);
    added.bare = bare;
    added.accepts = accepts;
}

void Verb::flag(const std::string& names, bool& target, const std::string& help) {
    option(names, "", help, [&target](const std::string&) { target = true; }).may_repeat = true;
}

void Verb::argument(const std::string& name, std::string& target, const std::string& help) {
    const auto take = [&target](const std::string& text) { target = text; };
    option(name, "", help, take, true).is_word = true;
}

void Verb::arguments(const std::string& name, std::vector<std::string>& values,
                     const std::string& help, bool required) {
    const auto take = [&values](const std::string& text) { values.push_back(text); };
    Option& added = option(name, "", help, take, required);
    added.is_word = added.may_repeat = true;
}

Option* Verb::find(const std::string& name) {
    const auto found = std::ranges::find_if(
        options, [&](const Option& option) { return std::ranges::count(option.names, name) > 0; });
    return found == options.end() ? nullptr : &*found;
}

Verb& read_command_line(Verb& program, const std::string& version, std::vector<std::string> words) {
    std::string answer;
    const auto only_print = [&program](const std::string& text) -> Verb& {
        program.run = [text] {
            print_result(text);
            return static_cast<int>(ExitCode::done);
        };
        return program;
    };
    const auto print_version = [&](const std::string&) { answer = version + "\n"; };
    const auto print_manual = [&](const std::string&) { answer = man_page(program, version); };
    const auto print_script = [&](const std::string& shell) { answer = completion_script(shell); };
    program.option("--version", "", "Display program version information and exit", print_version);
    program.option("--man", "", "Print the manual page in roff", print_manual);
    program.option("--completions", "bash|zsh|fish", "Print a completion script for a shell",
                   print_script);
    if (!words.empty() && words.front() == "--complete") {
        return only_print(completions_of(program, {words.begin() + 1, words.end()}));
    }
    if (!words.empty() && words.front() == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    }
    Reader reader(program, std::move(words));
    Verb& verb = reader.read();
    if (verb.wants_help) return only_print(help_text(verb));
    if (!answer.empty()) return only_print(answer);
    reader.check();
    return verb;
}

}  // namespace rt
