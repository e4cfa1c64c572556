// SPDX-License-Identifier: Apache-2.0
#include "host/scene/line_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "host/scene/scene.h"

namespace rt {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Offset after the first unescaped line feed at or after `at`; the text's end if there is none.
std::size_t next_cut(std::string_view text, std::size_t at) {
    while (true) {
        const std::size_t feed = text.find('\n', at);
        if (feed == text.npos) return text.size();
        const std::string_view before = text.substr(0, feed);
        const bool joined = before.ends_with('\\') || before.ends_with("\\\r");
        if (!joined) return feed + 1;
        at = feed + 1;
    }
}

}  // namespace

/// Length of a backslash and the line end that it escapes, or 0.
std::size_t LineScanner::continuation() const {
    if (*at_ != '\\' || end_ - at_ < 2) return 0;
    if (at_[1] == '\n') return 2;
    if (at_[1] != '\r') return 0;
    return end_ - at_ > 2 && at_[2] == '\n' ? 3 : 2;
}

bool LineScanner::at_word_end() const {
    return at_line_end() || is_blank(*at_) || *at_ == '#' || continuation() > 0;
}

bool LineScanner::word_follows() {
    while (!at_line_end()) {
        if (const std::size_t joined = continuation()) {
            at_ += joined;
        } else if (is_blank(*at_)) {
            ++at_;
        } else {
            return *at_ != '#';
        }
    }
    return false;
}

std::string_view LineScanner::word() {
    if (!word_follows()) return {};
    const char* start = at_;
    while (!at_word_end()) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
}

std::string_view LineScanner::rest() {
    while (!at_line_end() && is_blank(*at_)) ++at_;
    const char* start = at_;
    while (!at_line_end()) ++at_;
    const char* stop = at_;
    while (stop != start && is_blank(stop[-1])) --stop;
    return {start, static_cast<std::size_t>(stop - start)};
}

/// Fast path: most lines are short, without backslashes or carriage returns.
bool LineScanner::skip_plain_line() {
    constexpr std::ptrdiff_t most = 512;
    const auto window = static_cast<std::size_t>(std::min(end_ - at_, most));
    const auto* feed = static_cast<const char*>(std::memchr(at_, '\n', window));
    if (!feed) return false;
    auto size = static_cast<std::size_t>(feed - at_);
    if (size > 0 && feed[-1] == '\r') --size;
    if (size > 0 && (std::memchr(at_, '\\', size) || std::memchr(at_, '\r', size))) return false;
    at_ = feed + 1;
    return true;
}

void LineScanner::next_line() {
    if (skip_plain_line()) return;
    bool comment = false;
    while (!at_line_end()) {
        comment = comment || *at_ == '#';
        const std::size_t joined = comment ? 0 : continuation();
        at_ += joined > 0 ? joined : 1;
    }
    if (at_ == end_) return;
    if (*at_ == '\r' && end_ - at_ > 1 && at_[1] == '\n') ++at_;
    ++at_;
}

bool LineScanner::find_word() {
    while (!word_follows()) {
        if (at_ == end_) return false;
        next_line();
    }
    return true;
}

std::optional<double> LineScanner::number(bool may_be_infinite) {
    if (!word_follows()) return std::nullopt;
    const char* const start = at_;
    const char* digits = *at_ == '+' && end_ - at_ > 1 && at_[1] != '-' ? at_ + 1 : at_;
    double value = 0;
    const auto result = std::from_chars(digits, end_, value);
    at_ = result.ptr;
    if (result.ec == std::errc::result_out_of_range) {
        value = std::strtod(std::string(digits, at_).c_str(), nullptr);
    } else if (result.ec != std::errc()) {
        at_ = start;
        return std::nullopt;
    }
    const bool is_windows_nan = at_ != end_ && *at_ == '#' && at_[-1] == '.';  // "-1.#IND"
    if (at_word_end() && !is_windows_nan && (may_be_infinite || std::isfinite(value))) return value;
    at_ = start;
    return std::nullopt;
}

std::optional<std::int64_t> LineScanner::integer() {
    if (!word_follows()) return std::nullopt;
    const char* const start = at_;
    std::int64_t value = 0;
    const auto result = std::from_chars(at_, end_, value);
    at_ = result.ptr;
    if (result.ec == std::errc() && at_word_end()) return value;
    at_ = start;
    return std::nullopt;
}

std::optional<double> scan_number(LineScanner& scanner, std::string_view name, Mistakes& mistakes,
                                  const Remedy* remedy, std::size_t count) {
    const std::size_t offset = scanner.word_offset();
    const auto number = scanner.number();
    if (number && std::abs(*number) <= max_scene_number) return number;
    mistakes.report(remedy, offset,
                    fmt::format("{} is {}; write a number from -1e30 to 1e30", name,
                                found_text(scanner, number)),
                    count);
    return std::nullopt;
}

std::vector<std::size_t> line_cuts(std::string_view text, std::size_t chunk_bytes) {
    std::vector<std::size_t> cuts{0};
    while (cuts.back() < text.size()) {
        const std::size_t at = std::min(cuts.back() + chunk_bytes, text.size()) - 1;
        cuts.push_back(next_cut(text, at));
    }
    return cuts;
}

}  // namespace rt
