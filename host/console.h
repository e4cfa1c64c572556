// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// Opens /dev/null in place of a standard stream that came closed, so that no file of ours takes
/// its number. Call it first.
void open_missing_streams();

/// Text for people, to stderr: but for line ends, tabs, and a carriage return in front, what may
/// not be shown is escaped (printable). Never throws: a lost message must not lose a picture.
void print_message(const std::string& text);

/// Results, to stdout as they stand. Throws Error (ExitCode::output) when they cannot be written.
void print_result(const std::string& text);

/// Sees the results through to whatever stdout is; throws like print_result.
void flush_results();

}  // namespace rt
