// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_tokens.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "host/base/text.h"
#include "host/scene/scene_limits.h"
#include "host/scene/words.h"

namespace rt {
namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_nff_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }  // \t \n \v \f \r

/// Whether an out-of-range number underflows rather than overflows: the exponent is negative, or
/// there are only zeros before the significant digits.
bool is_tiny(std::string_view text) {
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent != std::string_view::npos) return text.find('-', exponent) != text.npos;
    return text.find_first_of("123456789") > text.find('.');
}

/// Parses a word as a number; infinite on overflow, empty if it is none.
std::optional<double> number_of(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) return is_tiny(text) ? 0 : HUGE_VAL;
    return number;
}

}  // namespace

bool NffToken::is_number() const {
    if (text.empty()) return false;
    const char c = text[0];
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
}

NffTokens::NffTokens(Mistakes& mistakes) : mistakes_(mistakes), text_(mistakes.text()) {
    if (text_.starts_with(utf8_byte_order_mark)) at_ = utf8_byte_order_mark.size();
    scan();
    token_.first_on_line = true;
}

NffToken NffTokens::take() {
    const NffToken taken = token_;
    scan();
    return taken;
}

void NffTokens::scan() {
    bool new_line = false;
    bool comment = false;
    for (; at_ < text_.size(); ++at_) {
        const char c = text_[at_];
        if (is_line_end(c)) {
            new_line = true;
            comment = false;
        } else if (c == '#') {
            comment = true;
        } else if (!comment && !is_nff_blank(c)) {
            break;
        }
    }
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_nff_blank(text_[at_]) && text_[at_] != '#') ++at_;
    token_ = {text_.substr(start, at_ - start), start, new_line};
}

/// Whether the next token is a number, or looks meant as one.
bool NffTokens::has_number(std::string_view name) {
    if (token_.text.empty()) {
        mistakes_.add(token_.offset,
                      fmt::format("the file ends before {}; write {}", name, usage_));
        return false;
    }
    if (token_.is_number() || number_of(token_.text)) return true;
    mistakes_.add(token_.offset, fmt::format("expected {}, found {}; write {}", name,
                                             in_quotes(token_.text), usage_));
    return false;
}

std::optional<double> NffTokens::read_number(std::string_view name) {
    if (!has_number(name)) return std::nullopt;
    const NffToken token = take();
    const auto number = number_of(token.text);
    if (number && std::abs(*number) <= max_scene_number) return number;
    mistakes_.add(token.offset, fmt::format("{} is {}; write a number from -1e30 to 1e30", name,
                                            in_quotes(token.text)));
    return std::nullopt;
}

std::optional<double> NffTokens::read_not_negative(std::string_view name) {
    const std::size_t offset = token_.offset;
    const auto number = read_number(name);
    if (!number || *number >= 0) return number;
    mistakes_.add(offset, fmt::format("{} is {}; write 0 or more", name, *number));
    return std::nullopt;
}

std::optional<int> NffTokens::read_integer(std::string_view name, int low, int high) {
    if (!has_number(name)) return std::nullopt;
    const NffToken token = take();
    const auto number = number_of(token.text);
    if (number && *number >= low && *number <= high && *number == std::floor(*number)) {
        return static_cast<int>(*number);
    }
    mistakes_.add(token.offset, fmt::format("{} is {}; write a whole number from {} to {}", name,
                                            in_quotes(token.text), low, high));
    return std::nullopt;
}

std::optional<glm::dvec3> NffTokens::read_vec3(std::string_view name) {
    const auto x = read_number(name);
    const auto y = x ? read_number(name) : std::nullopt;
    const auto z = y ? read_number(name) : std::nullopt;
    return z ? std::optional(glm::dvec3(*x, *y, *z)) : std::nullopt;
}

std::optional<glm::dvec3> NffTokens::read_color(std::string_view name) {
    const auto r = read_not_negative(name);
    const auto g = r ? read_not_negative(name) : std::nullopt;
    const auto b = g ? read_not_negative(name) : std::nullopt;
    return b ? std::optional(glm::dvec3(*r, *g, *b)) : std::nullopt;
}

}  // namespace rt
