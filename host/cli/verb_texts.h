// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// The command line's help on an option or positional argument.
struct OptionText {
    std::vector<std::string> names;  ///< "-o", "--output"; of an argument: "SCENE"
    std::string type;                ///< of its value: "FILE", "float|double"; empty: no value
    std::string help;
    std::string group;  ///< its heading in --help
    bool is_word = false, is_required = false, may_repeat = false;

    /// Of an argument, as the command line shows it.
    std::string word() const { return names.front() + (may_repeat ? "..." : ""); }
};

/// The help on the program or a verb.
struct VerbText {
    std::string name, help;
    std::vector<OptionText> options;
    std::vector<VerbText> verbs;
};

/// The manual page of section 1, in roff. `version` begins with the program's name.
std::string man_page(const VerbText& program, const std::string& version);

/// What the last of these words, which may be empty, can become: a verb, an option or its value; a
/// line each, with its help after a tab. Empty where it is the name of a file.
std::string completions_of(const VerbText& program, std::vector<std::string> words);

/// The script that completes command lines in "bash", "zsh" or "fish", by `mirrorball --complete
/// WORD...`. Empty for another shell.
std::string completion_script(const std::string& shell);

}  // namespace rt
