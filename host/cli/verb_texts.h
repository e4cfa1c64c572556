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
    bool is_word = false;
    bool is_required = false;
};

/// The help on the program or a verb.
struct VerbText {
    std::string name, help;
    std::vector<OptionText> options;
    std::vector<VerbText> verbs;
};

/// The manual page of section 1, in roff. `version` begins with the program's name.
std::string man_page(const VerbText& program, const std::string& version);

/// The script that completes verbs, options and their values in "bash", "zsh" or "fish". Empty for
/// another shell.
std::string completions(const VerbText& program, const std::string& shell);

}  // namespace rt
