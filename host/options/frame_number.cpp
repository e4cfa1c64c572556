// SPDX-License-Identifier: Apache-2.0
#include "host/options/frame_number.h"

#include <cctype>
#include <filesystem>

namespace rt {

namespace {

constexpr int most_digits = 9;

/// Whether a placeholder can end there, rather than being part of a word, as in "50%share".
bool ends_at(const std::string& name, std::size_t at) {
    return at == name.size() || std::isalnum(static_cast<unsigned char>(name[at])) == 0;
}

/// The frame number that starts with the '%' at `at`.
std::optional<FrameNumber> frame_number_at(const std::string& name, std::size_t at) {
    std::size_t end = at + 1;
    int digits = 0;
    while (end < name.size() && name[end] >= '0' && name[end] <= '9' && digits <= most_digits) {
        digits = 10 * digits + (name[end++] - '0');
    }
    if (end == name.size() || name[end] != 'd' || digits > most_digits) return std::nullopt;
    if (!ends_at(name, end + 1)) return std::nullopt;
    return FrameNumber{at, end + 1 - at, digits == 0 ? 1 : digits};
}

}  // namespace

std::optional<FrameNumber> find_frame_number(const std::string& name) {
    std::optional<FrameNumber> found;
    for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
        const std::optional<FrameNumber> number = frame_number_at(name, at);
        if (number && found) return std::nullopt;
        if (number) found = number;
    }
    return found;
}

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

}  // namespace rt
