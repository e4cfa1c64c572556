// SPDX-License-Identifier: Apache-2.0
#include "host/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/verb_texts.h"
#include "host/scene/words.h"

namespace rt {

namespace {

CLI::App& app_of(void* app) { return *static_cast<CLI::App*>(app); }

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

VerbText text_of(const CLI::App& verb) {
    VerbText text{verb.get_name(), verb.get_description(), {}, {}};
    for (const CLI::Option* option : verb.get_options()) {
        OptionText one;
        for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
        one.is_word = one.names.empty();
        one.is_required = option->get_required();
        one.may_repeat = option->get_items_expected_max() > 1;
        if (one.is_word) one.names.push_back(option->get_name());
        if (!one.is_word && option->get_items_expected_max() > 0)
            one.type = option->get_type_name();
        one.help = option->get_description();
        one.group = option->get_group();
        text.options.push_back(std::move(one));
    }
    for (const CLI::App* one : verbs_of(verb)) {
        text.verbs.push_back(text_of(*one));
    }
    return text;
}

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

/// The help on the program or a verb, called `name`: its options by group, in their order.
std::string help_text(const VerbText& verb, const std::string& name) {
    std::vector<std::pair<std::string, std::string>> groups;
    std::string words, verbs, usage;
    for (const OptionText& option : verb.options) {
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
    for (const VerbText& one : verb.verbs) verbs += help_entry(one.name, one.help);
    std::string text =
        fmt::format("Usage: {}{}{}{}\n{}\n", name, groups.empty() ? "" : " [OPTIONS]",
                    verbs.empty() ? "" : " VERB", usage, verb.help);
    if (!words.empty()) text += "\n" + words;
    if (!verbs.empty()) text += "\nVerbs (mirrorball help VERB tells more):\n" + verbs;
    for (const auto& [group, entries] : groups) text += fmt::format("\n{}:\n{}", group, entries);
    return text;
}

}  // namespace

struct CommandLineParser {
    /// An option whose value may be omitted.
    struct OptionalValue {
        const CLI::App* verb;
        std::string name, bare;
        AcceptsText accepts;
    };

    CLI::App app;
    std::string group = "Options";  ///< of the options that are added next
    std::vector<OptionalValue> optional_values;
    std::string place;  ///< "mirrorball render": whose help to consult

    explicit CommandLineParser(const CommandLineTexts& texts) : app(texts.about, texts.program) {
        app.set_version_flag("--version", texts.version);
        app.add_flag("--man")->description("Print the manual page in roff");
        app.add_option("--completions")
            ->description("Print a completion script for a shell")
            ->type_name("bash|zsh|fish");
        app.require_subcommand(1);
        place = texts.program;
    }

    CommandLine root() { return {*this, &app}; }

    [[noreturn]] void refuse_line(const std::string& what) const {
        usage_error("{}{} '{} --help'", what, what.ends_with("?") ? " See" : "; see", place);
    }

    /// The verb or nested verb that the words begin with; rejects unknown ones.
    CLI::App& chosen_verb(const std::vector<std::string>& words, std::size_t& at) {
        CLI::App* verb = &app;
        while (at < words.size() && !words[at].starts_with("-") && !verbs_of(*verb).empty()) {
            std::vector<std::string> names;
            for (const CLI::App* one : verbs_of(*verb)) names.push_back(one->get_name());
            if (std::ranges::count(names, words[at]) == 0) {
                refuse_line(fmt::format("unknown verb '{}'; available: {}{}", words[at],
                                        fmt::join(names, ", "), guess_text(words[at], names)));
            }
            place += " " + words[at];
            verb = verb->get_subcommand(words[at++]);
        }
        if (at == words.size() && !verbs_of(*verb).empty()) refuse_line("a verb is required");
        return *verb;
    }

    void check_option(const CLI::App& verb, const std::string& word) const {
        const std::string name = word.substr(0, word.find('='));
        if (!name.starts_with("--") || name == "--") return;
        std::vector<std::string> names;
        for (const CLI::Option* option : verb.get_options()) {
            for (const std::string& known : option->get_lnames()) {
                names.push_back("--" + known);
                if (names.back() != name) continue;
                if (word == name + "=") refuse_line("'" + word + "' has no value");
                const bool is_flag = option->get_items_expected_max() == 0;
                if (is_flag && word != name) refuse_line("'" + name + "' takes no value");
                return;
            }
        }
        refuse_line(fmt::format("unknown option '{}'{}", name, guess_text(name, names)));
    }

    const OptionalValue* optional_value(const CLI::App& verb, const std::string& word) const {
        const auto found = std::ranges::find_if(optional_values, [&](const auto& one) {
            return one.verb == &verb && one.name == word;
        });
        return found == optional_values.end() ? nullptr : &*found;
    }

    /// Joins each optional value to its option by "=", so that values and scenes are not mixed up.
    std::vector<std::string> joined(const std::vector<std::string>& words) {
        std::size_t at = 0;
        const CLI::App& verb = chosen_verb(words, at);
        std::vector<std::string> result(words.begin(),
                                        words.begin() + static_cast<std::ptrdiff_t>(at));
        for (bool options = true; at < words.size(); ++at) {
            options = options && words[at] != "--";
            const OptionalValue* const one = options ? optional_value(verb, words[at]) : nullptr;
            if (one == nullptr) {
                if (options) check_option(verb, words[at]);
                result.push_back(words[at]);
                continue;
            }
            const bool has_value = at + 1 < words.size() && one->accepts(words[at + 1]);
            result.push_back(one->name + "=" + (has_value ? words[at + 1] : one->bare));
            if (has_value) ++at;
        }
        return result;
    }

    /// The man page or completion script, if the first word asks for one; else empty.
    std::string installed_text(const std::vector<std::string>& words) {
        if (words.size() == 1 && words[0] == "--man") return man_page(text_of(app), app.version());
        if (words.size() != 2 || words[0] != "--completions") return "";
        const std::string text = completion_script(words[1]);
        if (text.empty())
            refuse_line("--completions '" + words[1] + "': expected bash, zsh or fish");
        return text;
    }

    std::string read(std::vector<std::string> words) {
        if (!words.empty() && words.front() == "help") {
            words.erase(words.begin());
            words.emplace_back("--help");
        }
        if (!words.empty() && words.front() == "--complete") {
            return completions_of(text_of(app), {words.begin() + 1, words.end()});
        }
        if (const std::string text = installed_text(words); !text.empty()) return text;
        try {
            std::vector<std::string> last_first = joined(words);
            std::reverse(last_first.begin(), last_first.end());
            app.parse(std::move(last_first));
        } catch (const CLI::CallForHelp&) {
            const CLI::App* verb = &app;
            while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
            return help_text(text_of(*verb), place);
        } catch (const CLI::CallForVersion&) {
            return app.version() + "\n";
        } catch (const CLI::ArgumentMismatch& error) {
            const std::string what = error.what();
            const bool is_twice = what.find(": At Most 1") != what.npos;
            refuse_line(what.substr(0, what.find(':')) +
                        (is_twice ? " is given twice" : " requires a value"));
        } catch (const CLI::ExtrasError&) {
            refuse_line("unexpected argument '" + app.remaining(true).front() + "'");
        } catch (const CLI::ParseError& error) {
            refuse_line(error.what());
        }
        return "";
    }
};

CommandLine CommandLine::verb(const std::string& name, const std::string& help) const {
    CLI::App& parent = app_of(app_);
    CLI::App* const verb = parent.add_subcommand(name, help);
    if (parent.get_parent() != nullptr) parent.require_subcommand(1);
    parser_->group = "Options";
    return {*parser_, verb};
}

void CommandLine::option(const std::string& name, const std::string& type, const std::string& help,
                         const TakeText& take, bool required) const {
    const auto read = [take, shown = name.substr(0, name.find(','))](const std::string& text) {
        try {
            take(text);
        } catch (const BadValue& bad) {
            throw Error(bad.exit_code,
                        fmt::format("{} '{}': {}", shown, printable(bad.value), bad.reason));
        }
    };
    app_of(app_)
        .add_option_function<std::string>(name, read, help)
        ->type_name(type)
        ->group(parser_->group)
        ->required(required);
}

void CommandLine::group(const std::string& name) const { parser_->group = name; }

void CommandLine::value(const std::string& name, const std::string& type, std::string& target,
                        const std::string& help) const {
    option(name, type, help, [&target](const std::string& text) {
        if (text.empty()) throw BadValue{text, "expected a name"};
        target = text;
    });
}

void CommandLine::optional_value(const std::string& name, const std::string& type,
                                 const std::string& help, const std::string& bare,
                                 const AcceptsText& accepts, const TakeText& take) const {
    option(name, "[" + type + "]", help, take);
    parser_->optional_values.push_back({&app_of(app_), name, bare, accepts});
}

void CommandLine::flag(const std::string& names, bool& value, const std::string& help) const {
    app_of(app_).add_flag(names, value, help)->group(parser_->group);
}

void CommandLine::argument(const std::string& name, std::string& value,
                           const std::string& help) const {
    app_of(app_).add_option(name, value, help)->required();
}

void CommandLine::arguments(const std::string& name, std::vector<std::string>& values,
                            const std::string& help, bool required) const {
    app_of(app_).add_option(name, values, help)->required(required);
}

void CommandLine::when_chosen(const std::function<void()>& action) const {
    app_of(app_).callback(action);
}

bool CommandLine::given(const std::string& option) const { return app_of(app_).count(option) > 0; }

std::string read_command_line(const CommandLineTexts& texts,
                              const std::function<void(const CommandLine&)>& describe, int argc,
                              const char* const* argv) {
    CommandLineParser parser(texts);
    describe(parser.root());
    return parser.read(std::vector<std::string>(argv + 1, argv + std::max(argc, 1)));
}

}  // namespace rt
