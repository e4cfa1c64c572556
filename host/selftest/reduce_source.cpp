// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "host/selftest/selftest.h"

namespace rt {

namespace {

struct SourcePart {
    std::string name;  ///< of a function; empty: always kept, with all it mentions
    std::string text;
    std::vector<std::string> words;
};

std::vector<std::string> words_of(const std::string& text) {
    static const std::regex word("\\w+");
    const std::sregex_token_iterator first(text.begin(), text.end(), word), end;
    return {first, end};
}

/// The word before the first parenthesis: a function's name. PROBE2(dot3, ..) makes probe_dot3.
std::string name_of_function(const std::string& text) {
    const std::size_t open = text.find('(');
    const std::vector<std::string> before = words_of(text.substr(0, open));
    if (open == text.npos || before.empty()) return "";
    const bool is_made = before.back().starts_with("PROBE") && before.size() == 1;
    return is_made ? "probe_" + words_of(text.substr(open)).at(0) : before.back();
}

/// One more line of the text, with those that a backslash continues.
std::string next_line(const std::string& text, std::size_t& at) {
    const std::size_t start = at;
    do {
        at = std::min(text.find('\n', at), text.size() - 1) + 1;
    } while (at < text.size() && at >= 2 && text[at - 2] == '\\');
    return text.substr(start, at - start);
}

/// The functions of the kernels, and what is between them.
std::vector<SourcePart> parts_of(const std::string& source) {
    std::vector<SourcePart> parts;
    const std::string text = std::regex_replace(source, std::regex("//[^\n]*"), "");
    std::string open;  // a declaration or function so far
    int depth = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string line = next_line(text, at);
        const std::size_t end = line.find_last_not_of(" \n\\");
        if (line.starts_with("#line") || (open.empty() && end == line.npos)) continue;
        if (line.starts_with("#") && depth == 0) {
            parts.push_back({"", line, words_of(line)});
            continue;
        }
        open += line;
        for (const char c : line) depth += c == '{' || c == '(' ? 1 : c == '}' || c == ')' ? -1 : 0;
        const char last = end == line.npos ? ' ' : line[end];
        if (depth != 0 || (last != ';' && last != '}' && last != ')')) continue;
        const bool is_probe = open.starts_with("PROBE") && !open.starts_with("PROBE_STRUCT");
        const bool is_type = open.starts_with("typedef") || open.starts_with("enum");
        const bool is_function = (last == '}' || is_probe) && !is_type;
        parts.push_back({is_function ? name_of_function(open) : "", open, words_of(open)});
        open.clear();
    }
    return parts;
}

}  // namespace

std::string reduced_to_kernel(const std::string& source, const std::string& kernel) {
    const std::vector<SourcePart> parts = parts_of(source);
    std::vector<std::string> pending{kernel};
    for (const SourcePart& part : parts) {
        if (part.name.empty()) pending.insert(pending.end(), part.words.begin(), part.words.end());
    }
    std::set<std::string> found;
    while (!pending.empty()) {
        const std::string word = pending.back();
        pending.pop_back();
        if (!found.insert(word).second) continue;
        for (const SourcePart& part : parts) {
            if (part.name != word) continue;
            pending.insert(pending.end(), part.words.begin(), part.words.end());
        }
    }
    std::string text;
    for (const SourcePart& part : parts) {
        if (part.name.empty() || found.count(part.name) != 0) text += part.text;
    }
    return text;
}

}  // namespace rt
