// SPDX-License-Identifier: Apache-2.0
#include "host/base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "host/base/error.h"
#include "host/base/text.h"

namespace rt {

namespace {

std::atomic<bool> bar_shown = false;

[[noreturn]] void throw_lost_results() {
    throw Error(ExitCode::output, std::string("standard output: cannot write: ") +
                                      std::strerror(errno) + "; redirect it elsewhere");
}

/// Length of the printable prefix of a text, line ends and tabs included.
std::size_t shown_length(std::string_view text) {
    std::size_t length = 0;
    while (length < text.size()) {
        const bool blank = text[length] == '\n' || text[length] == '\t';
        const std::size_t more = blank ? 1 : printable_length(text.substr(length));
        if (more == 0) break;
        length += more;
    }
    return length;
}

/// Writes text of any origin, escaped where unprintable. Allocates nothing.
void write_lines(std::string_view text) {
    while (!text.empty()) {
        const std::size_t shown = shown_length(text);
        std::fwrite(text.data(), 1, shown, stderr);
        text.remove_prefix(shown);
        if (text.empty()) return;
        std::fprintf(stderr, "\\x%02x", static_cast<unsigned char>(text[0]));
        text.remove_prefix(1);
    }
}

}  // namespace

void open_missing_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
        // open takes the lowest free number, which is this stream's. What is written there fails.
        if (open("/dev/null", O_RDONLY) != stream) return;
    }
}

void print_message(const std::string& text) {
    write_lines(text);
    std::fflush(stderr);
}

void print_note(const std::string& note) { print_message("mirrorball: " + note + "\n"); }

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) print_note(note);
}

void print_bar(const std::string& text, bool last) {
    bar_shown = !last;
    std::fputc('\r', stderr);
    print_message(text + (last ? "\n" : ""));
}

bool bar_is_shown() { return bar_shown; }

void print_error(const char* message) noexcept {
    for (const char* part : {bar_shown ? "\n" : "", "mirrorball: ", message, "\n"}) {
        write_lines(part);
    }
    std::fflush(stderr);
}

void print_result(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) throw_lost_results();
}

void flush_results() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw_lost_results();
}

}  // namespace rt
