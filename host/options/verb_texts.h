// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// What the command line tells of an option, or of a word that stands by its place.
struct OptionText {
    std::vector<std::string> names;  ///< "-o", "--output"; of a word its own: "SCENE"
    std::string type;                ///< of its value: "FILE", "float|double"; empty: it has none
    std::string help;
    bool is_word = false;
};

/// What it tells of the program or of a verb.
struct VerbText {
    std::string name, help;
    std::vector<OptionText> options;
    std::vector<VerbText> verbs;
};

/// The manual page of section 1, in roff.
std::string man_page(const VerbText& program, const std::string& version);

/// What a shell completes verbs, options and their values by: "bash", "zsh" or "fish". Empty for
/// another shell.
std::string completions(const VerbText& program, const std::string& shell);

}  // namespace rt
