// SPDX-License-Identifier: Apache-2.0
#include "host/options/parse.h"

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "host/opencl/device_spec.h"
#include "host/scene/words.h"

namespace rt {

namespace {

constexpr int largest_side = 65536;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

}  // namespace

void refuse(const std::string& value, const std::string& reason) { throw BadValue{value, reason}; }

void refuse_choice(const std::string& value, const std::vector<std::string>& choices) {
    const std::vector<std::string> first(choices.begin(), choices.end() - 1);
    refuse(value,
           fmt::format("expected {}{}{}{}", fmt::join(first, ", "), first.empty() ? "" : " or ",
                       choices.back(), guess_text(value, choices)));
}

PictureSize parse_size(const std::string& text) {
    const auto numbers = parse_integers(text, 'x');
    if (!numbers || numbers->size() > 2) {
        refuse(text, "expected WIDTHxHEIGHT or N, in pixels, such as 640x480 or 500");
    }
    const PictureSize size{numbers->front(), numbers->back()};
    if (size.width < 1 || size.height < 1) refuse(text, "each side must be at least 1 pixel");
    if (size.width > largest_side || size.height > largest_side ||
        std::int64_t{size.width} * size.height > most_pixels) {
        throw BadValue{text,
                       fmt::format("too large; at most {} pixels per side and {} in total",
                                   largest_side, most_pixels),
                       ExitCode::limit};
    }
    return size;
}

AaMode parse_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode) refuse(text, std::string("expected ") + aa_mode_help);
    return *mode;
}

std::string parse_device(const std::string& text) {
    if (text.empty()) refuse(text, "expected a device, or auto");
    parse_device_specs(text);
    return text;
}

std::vector<std::string> split_list(const std::string& text, const std::string& reason) {
    std::vector<std::string> parts;
    std::size_t at = 0;
    for (;;) {
        const std::size_t comma = text.find(',', at);
        parts.push_back(text.substr(at, comma - at));
        if (parts.back().empty()) refuse(text, reason);
        if (comma == std::string::npos) return parts;
        at = comma + 1;
    }
}

std::optional<std::vector<int>> parse_integers(std::string_view text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        int number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error == std::errc::result_out_of_range) {
            number = std::numeric_limits<int>::max();
        } else if (error != std::errc{}) {
            return std::nullopt;
        }
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != separator) return std::nullopt;
        at = stop + 1;
    }
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

}  // namespace rt
