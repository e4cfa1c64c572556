// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// Opens /dev/null on each standard stream that is closed, for reading: no file of ours gets its
/// number, and what is written there is an error. Call it first.
void open_missing_streams();

/// Prints text to stderr. Line ends and tabs are kept; other unprintable characters are escaped
/// (printable). Never throws: a lost message must not lose a picture.
void print_message(const std::string& text);

/// Prints "mirrorball: note" as a line.
void print_note(const std::string& note);
void print_notes(const std::vector<std::string>& notes);

/// Overwrites the cursor's line, without a line end: a progress bar. `last` ends the line.
void print_bar(const std::string& text, bool last);

/// Whether the cursor is at the end of a progress bar; safe in a signal handler.
bool bar_is_shown();

/// Prints "mirrorball: MESSAGE". Allocates nothing, since memory may have run out.
void print_error(const char* message) noexcept;

/// Writes results to stdout unchanged. Throws Error (ExitCode::output) when they cannot be written.
void print_result(const std::string& text);

/// Flushes stdout; throws like print_result.
void flush_results();

}  // namespace rt
