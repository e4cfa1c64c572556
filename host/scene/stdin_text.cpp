// SPDX-License-Identifier: Apache-2.0
#include "host/scene/stdin_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

#include "host/base/error.h"
#include "host/scene/json_document.h"

namespace rt {
namespace {

[[noreturn]] void refuse(const char* what) {
    throw Error(ExitCode::input, fmt::format("stdin: {} ({})", what, std::strerror(errno)));
}

/// Whether stdin is already our copy: nothing else is sealed.
bool is_kept() {
    const int seals = fcntl(STDIN_FILENO, F_GET_SEALS);
    return seals != -1 && (seals & F_SEAL_WRITE) != 0;
}

std::vector<char> read_to_end() {
    std::vector<char> text;
    char piece[1 << 16];
    for (;;) {
        const ssize_t got = read(STDIN_FILENO, piece, sizeof(piece));
        if (got == 0) return text;
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) refuse("cannot be read; send a scene to it");
        text.insert(text.end(), piece, piece + got);
        require_size("stdin", text.size(), max_json_bytes);
    }
}

}  // namespace

void keep_stdin() {
    if (is_kept()) return;
    const std::vector<char> text = read_to_end();
    std::string_view rest(text.data(), text.size());
    const FileDescriptor copy(memfd_create("scene", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    while (copy && !rest.empty()) {
        const ssize_t count = write(copy.number(), rest.data(), rest.size());
        if (count < 0 && errno != EINTR) break;
        if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
    }
    constexpr int seals = F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL;
    if (!copy || !rest.empty() || fcntl(copy.number(), F_ADD_SEALS, seals) != 0 ||
        dup2(copy.number(), STDIN_FILENO) < 0) {
        refuse("cannot be kept in memory; save the scene to a file");
    }
}

FileText read_stdin() {
    keep_stdin();
    const FileDescriptor file(fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0));
    return read_text_file(file, "stdin", max_json_bytes);
}

}  // namespace rt
