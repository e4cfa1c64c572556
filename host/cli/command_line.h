// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "host/base/error.h"

namespace rt {

/// Why the value of an option, or a part of it, is refused; its reader adds the option's name.
struct BadValue {
    std::string value, reason;
    ExitCode exit_code = ExitCode::usage;
};

/// Takes an option's value; throws BadValue to reject it.
using TakeText = std::function<void(const std::string&)>;
using AcceptsText = std::function<bool(const std::string&)>;

/// An option, a flag or a positional argument.
struct Option {
    std::vector<std::string> names;  ///< "-o", "--output"; of an argument: "SCENE"
    std::string type;  ///< of its value: "FILE", "float|double"; in brackets if it may be left out;
                       ///< empty: no value
    std::string help;
    std::string group;  ///< its heading in --help
    TakeText take;
    bool is_word = false, is_required = false, may_repeat = false;
    std::string bare;     ///< what it means without a value
    AcceptsText accepts;  ///< whether the next word is its value, which may be left out
    int given = 0;        ///< so many times

    /// Of an argument, as the command line shows it.
    std::string word() const { return names.front() + (may_repeat ? "..." : ""); }
};

struct WorkerEnd;

/// The program, or one of its verbs: what its command line may hold.
struct Verb {
    std::string path;  ///< "mirrorball render"
    std::string about;
    std::vector<Option> options;
    std::list<Verb> verbs;
    std::function<int()> run;           ///< returns the exit status: an ExitCode, or 128 + a signal
    bool measures = false;              ///< to be run in a worker process, for drivers may crash
    ExitCode crash = ExitCode::device;  ///< what a crash of that process means
    std::function<int(const WorkerEnd&)> crashed;  ///< reports what it told before; may be empty
    std::string group = "Options";                 ///< of the options that are added next
    bool wants_help = false;

    Verb(const std::string& path, const std::string& about);
    Verb(const Verb&) = delete;  // an option refers to it
    Verb& operator=(const Verb&) = delete;

    std::string name() const { return path.substr(path.rfind(' ') + 1); }

    Verb& verb(const std::string& name, const std::string& help) {
        return verbs.emplace_back(path + " " + name, help);
    }

    /// An option that takes a value. `names`: "--size", or "-o,--output".
    Option& option(const std::string& names, const std::string& type, const std::string& help,
                   const TakeText& take, bool required = false);

    /// An option whose value `parse` turns into the target's.
    template <typename T, typename Parse>
    void value(const std::string& names, const std::string& type, T& target, const Parse& parse,
               const std::string& help, bool required = false) {
        const auto take = [&target, parse](const std::string& text) { target = parse(text); };
        option(names, type, help, take, required);
    }

    /// An option whose value is a name: any text but an empty one, as from a script's unset
    /// variable.
    void value(const std::string& names, const std::string& type, std::string& target,
               const std::string& help);

    /// An option that may stand alone and then means `bare`. The next word is its value if
    /// `accepts` returns true for it; in `--name=VALUE` it always is.
    void optional_value(const std::string& name, const std::string& type, const std::string& help,
                        const std::string& bare, const AcceptsText& accepts, const TakeText& take);

    void flag(const std::string& names, bool& value, const std::string& help);

    /// A positional argument.
    void argument(const std::string& name, std::string& value, const std::string& help);
    void arguments(const std::string& name, std::vector<std::string>& values,
                   const std::string& help, bool required);

    /// The option or flag of that name; null if there is none.
    Option* find(const std::string& name);

    /// Whether it has that option or flag, and the command line does.
    bool given(const std::string& name) { return find(name) != nullptr && find(name)->given > 0; }
};

/// Reads the words after the program's name. Returns the verb to run: the program itself, which
/// prints a text, if help, the version, the manual page or completions were requested. Throws Error
/// (ExitCode::usage).
Verb& read_command_line(Verb& program, const std::string& version, std::vector<std::string> words);

/// The manual page of section 1, in roff. `version` begins with the program's name.
std::string man_page(const Verb& program, const std::string& version);

/// What the last of these words, which may be empty, can become: a verb, an option or its value; a
/// line each, with its help after a tab. Empty where it is the name of a file.
std::string completions_of(Verb& program, std::vector<std::string> words);

/// The script that completes command lines in a shell, by `mirrorball --complete WORD...`. Throws
/// BadValue for any other than "bash", "zsh" and "fish".
std::string completion_script(const std::string& shell);

/// How the program was started, and where it runs.
struct Invocation {
    std::vector<std::string> command;  ///< the program's own, to start workers
    std::string drivers;  ///< where OpenCL finds its .icd files: a folder, or one of them
    double seconds_before_main = 0;
};

/// Adds a verb to the command line, which refers to `call`. One file per verb.
using AddVerb = void(Verb& program, const Invocation& call);

AddVerb add_render, add_merge, add_compare, add_bench, add_converge, add_stress, add_report,
    add_devices, add_doctor, add_explain, add_scene, add_selftest, add_blame;

/// In the order of the help.
inline constexpr AddVerb* all_verbs[] = {
    add_render,  add_merge,  add_compare, add_bench, add_converge, add_stress, add_report,
    add_devices, add_doctor, add_explain, add_scene, add_selftest, add_blame};

}  // namespace rt
