// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace rt {

/// The text with the letters of ASCII in lower case.
inline std::string lower(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

/// ".nff" of "a/b.NFF".
inline std::string lower_extension(const std::string& path) {
    return lower(std::filesystem::path(path).extension().string());
}

}  // namespace rt
