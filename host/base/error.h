// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace rt {

/// How the program ends; the numbers are part of the interface (docs/features.md, "Exit codes").
enum class ExitCode : int {
    done = 0,
    different = 1,
    usage = 2,
    input = 3,
    output = 4,
    device = 5,
    non_finite = 6,
    limit = 7,
    incomplete = 8,
    bug = 70,
};

/// The message where no memory is left, wherever that happens.
inline constexpr const char* out_of_memory = "out of memory; render a smaller picture or scene";

/// The program's only exception type: what is wrong, where, and what to do, in one line (several
/// lines when several mistakes are reported together). Caught for main (exit_status_of), when
/// falling back to another device, and between the pictures of a batch.
class Error : public std::runtime_error {
   public:
    Error(ExitCode exit_code, const std::string& message)
        : std::runtime_error(message), exit_code_(exit_code) {}

    ExitCode exit_code() const { return exit_code_; }

   private:
    ExitCode exit_code_;
};

/// Rejects the command line: throws Error (ExitCode::usage) with the formatted message.
template <typename... Values>
[[noreturn]] void usage_error(fmt::format_string<Values...> format, Values&&... values) {
    throw Error(ExitCode::usage, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace rt
