// SPDX-License-Identifier: Apache-2.0
#include "host/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "host/error.h"

namespace rt {

namespace {

[[noreturn]] void throw_lost_results() {
    throw Error(ExitCode::output, std::string("standard output: cannot write the results: ") +
                                      std::strerror(errno) + "; send them elsewhere");
}

}  // namespace

void open_missing_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        // open takes the lowest free number, which is this stream's.
        if (fcntl(stream, F_GETFD) == -1 && errno == EBADF && open("/dev/null", O_RDWR) != stream) {
            return;
        }
    }
}

void print_message(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void print_result(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) throw_lost_results();
}

void flush_results() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw_lost_results();
}

}  // namespace rt
