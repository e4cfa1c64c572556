// SPDX-License-Identifier: Apache-2.0
#include "host/options/parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstdlib>
#include <limits>

#include "host/error.h"
#include "host/printable.h"
#include "host/scene/words.h"

namespace rt {

namespace {

constexpr int largest_side = 65536;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

}  // namespace

void refuse(const std::string& option, const std::string& value, const std::string& expected) {
    throw Error(ExitCode::usage, fmt::format("{} '{}': {}", option, printable(value), expected));
}

void refuse_choice(const std::string& option, const std::string& value,
                   const std::vector<std::string>& choices) {
    refuse(option, value,
           fmt::format("give {}{}", fmt::join(choices, ", "), guess_text(value, choices)));
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

PictureSize parse_size(const std::string& option, const std::string& text) {
    const auto numbers = parse_integers(text, 'x');
    if (!numbers || numbers->size() > 2) {
        refuse(option, text, "give WIDTHxHEIGHT or N, in pixels, as in 640x480 or 500");
    }
    const PictureSize size{numbers->front(), numbers->back()};
    if (size.width < 1 || size.height < 1) refuse(option, text, "a side must be at least 1 pixel");
    if (size.width > largest_side || size.height > largest_side ||
        std::int64_t{size.width} * size.height > most_pixels) {
        throw Error(ExitCode::limit,
                    fmt::format("{} '{}': a side may have at most {} pixels, a picture {}", option,
                                text, largest_side, most_pixels));
    }
    return size;
}

std::optional<std::vector<double>> parse_amounts(std::string_view text) {
    constexpr double largest = 1e30;
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        double number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || !(number >= 0 && number <= largest)) return std::nullopt;
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != ',') return std::nullopt;
        at = stop + 1;
    }
}

double parse_seconds(const std::string& option, const std::string& text, double least) {
    const auto seconds = parse_amounts(text);
    if (!seconds || seconds->size() != 1 || seconds->front() < least || seconds->front() > 1e8) {
        refuse(option, text, fmt::format("give seconds, {:g} or more", least));
    }
    return seconds->front();
}

double parse_percent(const std::string& option, const std::string& text, double most) {
    double percent = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, percent);
    const bool is_whole = stop == end || (stop + 1 == end && *stop == '%');
    if (error != std::errc{} || !is_whole || !(percent >= 0 && percent <= most)) {
        refuse(option, text, fmt::format("give a percentage from 0% to {:g}%", most));
    }
    return percent / 100;
}

void add_name(const CommandLine& verb, const std::string& option, const std::string& type,
              std::string& name, const std::string& help) {
    verb.option(option, type, help, [&name, option](const std::string& text) {
        if (text.empty()) refuse(option, text, "give a name");
        name = text;
    });
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

}  // namespace rt
