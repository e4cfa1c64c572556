// SPDX-License-Identifier: Apache-2.0
#include "tests/refusals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

namespace rt {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> announced(fs::path path) {
    std::vector<std::string> texts;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        for (const std::string mark : {"// expect ", "# expect ", "comment expect "}) {
            if (line.starts_with(mark)) texts.push_back(line.substr(mark.size()));
        }
    }
    std::ifstream beside(path.replace_extension(".expect"));
    for (std::string line; std::getline(beside, line);) texts.push_back(line);
    return texts;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension,
                               const std::string& start) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path& path = entry.path();
        if (path.extension() == extension && path.filename().string().starts_with(start)) {
            files.push_back(path);
        }
    }
    std::sort(files.begin(), files.end());
    EXPECT_FALSE(files.empty()) << folder << extension;
    return files;
}

}  // namespace

std::vector<fs::path> malformed_files(const std::string& extension) {
    return files_in(MIRRORBALL_BAD_SCENES_DIR, extension, "");
}

std::vector<fs::path> blemished_files(const std::string& extension, const std::string& start) {
    return files_in(fs::path(MIRRORBALL_BAD_SCENES_DIR).parent_path() / "scenes_blemished",
                    extension, start);
}

void expect_announced(const fs::path& file, const std::vector<std::string>& lines) {
    SCOPED_TRACE(file.string());
    const std::vector<std::string> texts = announced(file);
    EXPECT_FALSE(texts.empty());
    EXPECT_EQ(lines.size(), texts.size());
    for (const std::string& text : texts) {
        const std::string start = file.string() + ":" + text;
        const auto found = std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
            return line.starts_with(start);
        });
        EXPECT_TRUE(found) << "expected " << start;
    }
    if (testing::Test::HasFailure()) {
        for (const std::string& line : lines) std::cerr << "got " << line << "\n";
    }
}

void expect_announced(const fs::path& file, const Refusal& refusal) {
    EXPECT_EQ(refusal.exit_code, ExitCode::input) << file;
    std::vector<std::string> lines;
    std::istringstream text(refusal.message);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    expect_announced(file, lines);
}

}  // namespace rt
