// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/base/error.h"

// Input that must be refused, and the expected messages.
namespace rt {

struct Refusal {
    ExitCode exit_code = ExitCode::done;
    std::string message;
};

/// The refusal in the Error that an action throws; `done` and no message if it throws none.
template <typename Action>
Refusal refusal_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.exit_code(), error.what()};
    }
    return {};
}

/// The files of tests/scenes_bad, which are refused, that end in `extension` (".nff").
std::vector<std::filesystem::path> malformed_files(const std::string& extension);

/// The files of tests/scenes_blemished, which give notes, whose names begin with `start`.
std::vector<std::filesystem::path> blemished_files(const std::string& extension,
                                                   const std::string& start = "");

/// Expects exactly the messages or notes that the file itself announces: its lines "// expect
/// TEXT", "# expect TEXT" or "comment expect TEXT" (in the header of a PLY), or the lines of the
/// .expect file next to it. TEXT follows "FILE:" in a message.
void expect_announced(const std::filesystem::path& file, const std::vector<std::string>& lines);
void expect_announced(const std::filesystem::path& file, const Refusal& refusal);

}  // namespace rt
