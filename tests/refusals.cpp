// SPDX-License-Identifier: Apache-2.0
#include "tests/refusals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

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

}  // namespace

std::vector<fs::path> malformed_files(const std::string& extension, const std::string& start) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(MIRRORBALL_BAD_SCENES_DIR)) {
        const fs::path& path = entry.path();
        if (path.extension() == extension && path.filename().string().starts_with(start)) {
            files.push_back(path);
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

void expect_announced(const fs::path& file, const Refusal& refusal) {
    SCOPED_TRACE(file.string());
    EXPECT_EQ(refusal.exit_code, ExitCode::input);
    const std::vector<std::string> texts = announced(file);
    EXPECT_FALSE(texts.empty());
    for (const std::string& text : texts) {
        const std::string line = file.string() + ":" + text;
        EXPECT_NE(refusal.message.find(line), std::string::npos)
            << "expected " << line << "\nbut got  " << refusal.message;
    }
    const auto lines = std::count(refusal.message.begin(), refusal.message.end(), '\n') + 1;
    EXPECT_EQ(static_cast<std::size_t>(lines), texts.size()) << refusal.message;
}

}  // namespace rt
