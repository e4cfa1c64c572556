// SPDX-License-Identifier: Apache-2.0
#include "host/cli/batch_list.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <regex>
#include <sstream>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/image/output_path.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

/// Whether a placeholder can end there, rather than being part of a word, as in "50%share".
bool ends_at(const std::string& name, std::size_t at) {
    return at == name.size() || std::isalnum(static_cast<unsigned char>(name[at])) == 0;
}

/// The places of a frame's number; [1] is the least number of digits, if it is given.
std::vector<std::smatch> frame_numbers(const std::string& name) {
    static const std::regex number("%0*([1-9]?)d(?![[:alnum:]])");
    return {std::sregex_iterator(name.begin(), name.end(), number), std::sregex_iterator()};
}

/// The next name; empty at the end of the line.
std::optional<std::string> next_name(std::istringstream& words) {
    if ((words >> std::ws).eof()) return std::nullopt;
    std::string name;
    if (!(words >> std::quoted(name))) {
        usage_error("missing closing quote; put names with spaces in double quotes");
    }
    if (name.empty()) usage_error("empty name; expected SCENE or SCENE OUTPUT");
    return name;
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

std::optional<BatchItem> parse_batch_line(const std::string& line) {
    const bool is_marked = line.starts_with(utf8_byte_order_mark);  // some editors begin files so
    std::istringstream words(line.substr(is_marked ? utf8_byte_order_mark.size() : 0));
    BatchItem item;
    const std::optional<std::string> scene = next_name(words);
    if (!scene || scene->starts_with("#")) return std::nullopt;
    item.scene = *scene;
    item.output = next_name(words).value_or("");
    std::string more;
    if (words >> more) {
        usage_error(
            "unexpected '{}' after SCENE and OUTPUT; put names with spaces in double quotes", more);
    }
    return item;
}

std::vector<std::string> scenes_of_list(const std::string& path) {
    std::vector<std::string> scenes;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return scenes;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        try {
            if (const auto item = parse_batch_line(line)) scenes.push_back(item->scene);
        } catch (const Error&) {  // reported when its turn comes
        }
    }
    return scenes;
}

std::string frame_output(const std::string& pattern, int frame) {
    const std::vector<std::smatch> numbers = frame_numbers(pattern);
    if (numbers.size() != 1) return pattern;
    const std::smatch& number = numbers.front();
    return fmt::format("{}{:0{}}{}", number.prefix().str(), frame,
                       parse_number<int>(number[1].str()).value_or(1), number.suffix().str());
}

BatchPast::BatchPast(const std::vector<std::string>& records) {
    for (const std::string& record : records) {
        std::istringstream fields(record.substr(1));
        std::size_t picture = 0;
        int status = 0;
        if (record.starts_with('l')) {
            lines_.push_back(record.substr(1));
        } else if (fields >> picture >> status) {
            statuses_.emplace(picture, status);
        }
    }
}

void BatchPast::tell_line(const std::string& line) { tell_parent("l" + line); }

void BatchPast::tell_finished(std::size_t picture, int status) {
    tell_parent(fmt::format("f{} {}", picture, status));
}

std::optional<int> BatchPast::status_of(std::size_t picture) const {
    const auto found = statuses_.find(picture);
    return found == statuses_.end() ? std::nullopt : std::optional(found->second);
}

LineReader::LineReader(const std::string& path, std::deque<std::string> past)
    : past_(std::move(past)),
      file_(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (!file_) {
        throw Error(ExitCode::input, fmt::format("{}: cannot open the list of scenes: {}", path,
                                                 std::strerror(errno)));
    }
    struct stat status {};
    if (fstat(file_.number(), &status) == 0 && S_ISDIR(status.st_mode)) {
        throw Error(ExitCode::input,
                    path + ": is a directory; name a file that lists scenes, one per line");
    }
    if (path != "-" && S_ISREG(status.st_mode)) chunk_ = 4096;
}

/// Returns whether more was read.
bool LineReader::read_more() {
    pollfd ready{file_.number(), POLLIN, 0};
    if (poll(&ready, 1, -1) < 0) return false;  // interrupted by a signal, unlike read
    char chunk[4096];
    const ssize_t size = read(file_.number(), chunk, chunk_);
    if (size > 0) text_.append(chunk, static_cast<std::size_t>(size));
    return size > 0;
}

std::optional<std::string> LineReader::next() {
    if (!past_.empty()) {
        std::string line = std::move(past_.front());
        past_.pop_front();
        return line;
    }
    std::size_t end = text_.find('\n');
    while (end == std::string::npos && !at_end_) {
        at_end_ = !read_more();
        end = text_.find('\n');
    }
    if (text_.empty() || stop_flag() != 0) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end == std::string::npos ? end : end + 1);
    if (chunk_ == 1) BatchPast::tell_line(line);
    return line;
}

BatchList::BatchList(const RenderOptions& options, BatchPast& past) : options_(options) {
    if (!options.batch.empty()) lines_.emplace(options.batch, past.take_lines());
}

bool BatchList::take(BatchItem& item) {
    if (!options_.frames.empty()) {
        if (given_ == options_.frames.size()) return false;
        const int frame = options_.frames[given_++];
        item.frame = frame;
        item.where = fmt::format("frame {}: ", frame);
        item.scene = options_.scenes.front();
        item.output = frame_output(options_.output, frame);
        return true;
    }
    if (given_ < options_.scenes.size()) {
        item.scene = options_.scenes[given_++];
        return true;
    }
    while (lines_) {
        const std::optional<std::string> line = lines_->next();
        if (!line) break;
        item.where =
            fmt::format("{}:{}: ", options_.batch == "-" ? "stdin" : options_.batch, ++line_);
        const std::optional<BatchItem> parsed = parse_batch_line(*line);
        if (!parsed) continue;
        if (options_.batch == "-" && parsed->scene == stdin_scene) {
            usage_error("standard input is already the list of scenes; name a scene file");
        }
        item.scene = parsed->scene;
        item.output = parsed->output;
        return true;
    }
    return false;
}

bool BatchList::next(BatchItem& item) {
    item = {};
    item.number = ++number_;
    if (!take(item)) return false;
    if (item.output.empty()) item.output = batch_output(options_.output, item.scene);
    if (item.output.empty()) return true;
    if (!outputs_.insert(canonical_output(item.output)).second) {
        usage_error("{}: is already the output of another scene; give each scene its own file",
                    item.output);
    }
    return true;
}

}  // namespace rt
