// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/reproducer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "host/image/atomic_file.h"
#include "host/image/output_path.h"

namespace rt {

extern const char* const reproduce_program;  // contrib/reproduce/reproduce.c, embedded by CMake

namespace {

std::string without_comments(const std::string& source) {
    std::string text;
    for (std::size_t at = 0; at < source.size(); ++at) {
        if (source.compare(at, 2, "//") == 0) at = std::min(source.find('\n', at), source.size());
        if (source.compare(at, 2, "/*") == 0) at = source.find("*/", at) + 2;
        if (at < source.size()) text += source[at];
    }
    return text;
}

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
            words.back() += c;
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    if (words.back().empty()) words.pop_back();
    return words;
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

}  // namespace

SourceParts::SourceParts(const std::string& source) {
    const std::string text = without_comments(source);
    std::string open;  // a declaration or function so far
    int depth = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string line = next_line(text, at);
        const std::size_t end = line.find_last_not_of(" \n\\");
        if (line.starts_with("#line") || (open.empty() && end == line.npos)) continue;
        if (line.starts_with("#") && depth == 0) {
            parts_.push_back({"", line, words_of(line)});
            continue;
        }
        open += line;
        for (const char c : line) depth += c == '{' || c == '(' ? 1 : c == '}' || c == ')' ? -1 : 0;
        const char last = end == line.npos ? ' ' : line[end];
        if (depth != 0 || (last != ';' && last != '}' && last != ')')) continue;
        const bool is_probe = open.starts_with("PROBE") && !open.starts_with("PROBE_STRUCT");
        const bool is_type = open.starts_with("typedef") || open.starts_with("enum");
        const bool is_function = (last == '}' || is_probe) && !is_type;
        parts_.push_back({is_function ? name_of_function(open) : "", open, words_of(open)});
        open.clear();
    }
}

std::size_t SourceParts::place_of(const std::string& function) const {
    const auto part = std::ranges::find(parts_, function, &Part::name);
    return static_cast<std::size_t>(part - parts_.begin());
}

std::string SourceParts::reduced_to(const std::string& kernel) const {
    std::vector<std::string> pending{kernel};
    for (const Part& part : parts_) {
        if (part.name.empty()) pending.insert(pending.end(), part.words.begin(), part.words.end());
    }
    std::set<std::string> found;
    while (!pending.empty()) {
        const std::string word = pending.back();
        pending.pop_back();
        if (!found.insert(word).second) continue;
        for (const Part& part : parts_) {
            if (part.name != word) continue;
            pending.insert(pending.end(), part.words.begin(), part.words.end());
        }
    }
    std::string text;
    for (const Part& part : parts_) {
        if (part.name.empty() || found.count(part.name) != 0) text += part.text;
    }
    return text;
}

void write_reproducer(const std::string& folder, const KernelLaunch& launch,
                      const std::string& source, const std::string& readme) {
    create_output_folder(folder);
    const auto write = [&](const std::string& file, std::string_view text) {
        write_file_atomically(folder + "/" + file, std::as_bytes(std::span(text)));
    };
    std::string text =
        fmt::format("kernel {}\noptions {}\nnumbers {}\nglobal {}\nlocal {}\n", launch.kernel,
                    launch.options, launch.numbers, launch.whole_groups(), launch.group);
    for (std::size_t i = 0; i < launch.arguments.size(); ++i) {
        const auto& [kind, bytes] = launch.arguments[i];
        if (kind == "scratch") {
            text += fmt::format("scratch {}\n", bytes.size());
            continue;
        }
        const std::string file = fmt::format("argument{}.bin", i);
        text += kind + " " + file + "\n";
        write_file_atomically(folder + "/" + file, bytes);
    }
    write("launch.txt", text);
    write("kernel.cl", SourceParts(source).reduced_to(launch.kernel));
    write("reproduce.c", reproduce_program);
    write("README", readme);
}

}  // namespace rt
