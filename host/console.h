// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// Opens /dev/null in place of a standard stream that came closed, so that no file of ours takes
/// its number. Call it first.
void open_missing_streams();

/// Text for people, to stderr: but for line ends, tabs, and a carriage return in front, what may
/// not be shown is escaped (printable). Never throws: a lost message must not lose a picture.
void print_message(const std::string& text);

/// Each as a message of its own: what a scene's reader left out.
void print_notes(const std::vector<std::string>& notes);

/// Instead of the line that the cursor is on, without an end: a progress bar. `last` ends the line.
void print_bar(const std::string& text, bool last);

/// Whether the cursor is at the end of a bar; may be asked in a signal handler.
bool bar_is_shown();

/// "mirrorball: MESSAGE". Allocates nothing: memory may be what is lacking.
void print_error(const char* message) noexcept;

/// Results, to stdout as they stand. Throws Error (ExitCode::output) when they cannot be written.
void print_result(const std::string& text);

/// Sees the results through to whatever stdout is; throws like print_result.
void flush_results();

}  // namespace rt
