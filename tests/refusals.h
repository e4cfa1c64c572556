// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/error.h"

// Input that must be refused, and what is to be said about it.
namespace rt {

struct Refusal {
    ExitCode exit_code = ExitCode::done;
    std::string message;
};

/// Of the Error an action throws; done and no message when it throws none.
template <typename Action>
Refusal refusal_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.exit_code(), error.what()};
    }
    return {};
}

/// The files of tests/scenes_bad whose names end in the extension, such as ".nff", and begin so.
std::vector<std::filesystem::path> malformed_files(const std::string& extension,
                                                   const std::string& start = "");

/// Expects a refusal as input, with the messages that the file itself announces and no others: its
/// lines "// expect TEXT", "# expect TEXT" or "comment expect TEXT" (a PLY's stand in its header),
/// or the lines of the .expect file beside it. TEXT follows "FILE:" in a message.
void expect_announced(const std::filesystem::path& file, const Refusal& refusal);

}  // namespace rt
