// SPDX-License-Identifier: Apache-2.0
#include "host/cli/batch_list.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/image/output_path.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 28;  ///< of a list

/// Whether a placeholder can end there, rather than being part of a word, as in "50%share".
bool ends_at(const std::string& name, std::size_t at) {
    return at == name.size() || std::isalnum(static_cast<unsigned char>(name[at])) == 0;
}

/// The places of a frame's number; [1] is the least number of digits, if it is given.
std::vector<std::smatch> frame_numbers(const std::string& name) {
    static const std::regex number("%0*([1-9]?)d(?![[:alnum:]])");
    return {std::sregex_iterator(name.begin(), name.end(), number), std::sregex_iterator()};
}

std::string frame_output(const std::string& pattern, int frame) {
    const std::vector<std::smatch> numbers = frame_numbers(pattern);
    if (numbers.size() != 1) return pattern;
    const std::smatch& number = numbers.front();
    return fmt::format("{}{:0{}}{}", number.prefix().str(), frame,
                       parse_number<int>(number[1].str()).value_or(1), number.suffix().str());
}

/// The next name of a line; empty at its end.
std::optional<std::string> next_name(std::istringstream& words, const std::string& where) {
    if ((words >> std::ws).eof()) return std::nullopt;
    std::string name;
    if (!(words >> std::quoted(name))) {
        usage_error("{}missing closing quote; put names with spaces in double quotes", where);
    }
    if (name.empty()) usage_error("{}empty name; expected SCENE or SCENE OUTPUT", where);
    return name;
}

void add_line(const std::string& line, const std::string& where, std::vector<BatchItem>& items) {
    std::istringstream words(line);
    const std::optional<std::string> scene = next_name(words, where);
    if (!scene || scene->starts_with("#")) return;
    const std::string output = next_name(words, where).value_or("");
    if (const auto more = next_name(words, where)) {
        usage_error(
            "{}unexpected '{}' after SCENE and OUTPUT; put names with spaces in double quotes",
            where, *more);
    }
    items.push_back({where, *scene, output, {}});
}

void add_list(const std::string& path, std::vector<BatchItem>& items) {
    const bool is_stdin = path == "-";
    const FileText list = is_stdin ? read_stdin() : read_text_file(path, most_bytes);
    std::string_view text = list.view();
    if (text.starts_with(utf8_byte_order_mark)) {  // some editors begin files so
        text.remove_prefix(utf8_byte_order_mark.size());
    }
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string where = fmt::format("{}:{}: ", is_stdin ? "stdin" : path, ++number);
        add_line(line, where, items);
        if (is_stdin && !items.empty() && items.back().scene == stdin_scene) {
            usage_error("{}standard input is already the list of scenes; name a scene file", where);
        }
    }
}

void refuse_shared_outputs(const std::vector<BatchItem>& items) {
    std::set<std::string> outputs;
    for (const BatchItem& item : items) {
        if (item.output.empty() || outputs.insert(canonical_output(item.output)).second) continue;
        usage_error("{}{}: is already the output of another scene; give each scene its own file",
                    item.where, item.output);
    }
}

}  // namespace

bool has_frame_number(const std::string& name) { return frame_numbers(name).size() == 1; }

std::string batch_output(const std::string& pattern, const std::string& scene) {
    const std::string name = std::filesystem::path(scene).stem().string();
    std::string output;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const bool is_name = pattern.compare(i, 2, "%s") == 0 && ends_at(pattern, i + 2);
        output += is_name ? name : std::string(1, pattern[i]);
        if (is_name) ++i;
    }
    return output;
}

std::vector<BatchItem> batch_items(const RenderOptions& options) {
    std::vector<BatchItem> items;
    for (const int frame : options.frames) {
        items.push_back({fmt::format("frame {}: ", frame), options.scenes.front(),
                         frame_output(options.output, frame), frame});
    }
    if (!items.empty()) return items;
    for (const std::string& scene : options.scenes) items.push_back({"", scene, "", {}});
    if (!options.batch.empty()) add_list(options.batch, items);
    if (items.empty()) usage_error("the list contains no scenes");
    for (BatchItem& item : items) {
        if (item.output.empty()) item.output = batch_output(options.output, item.scene);
    }
    refuse_shared_outputs(items);
    return items;
}

}  // namespace rt
