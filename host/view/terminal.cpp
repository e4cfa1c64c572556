// SPDX-License-Identifier: Apache-2.0
#include "host/view/terminal.h"

#include <fcntl.h>
#include <langinfo.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <clocale>
#include <string>
#include <string_view>

#include "host/base/files.h"

namespace rt {

namespace {

/// For all of the answer: a terminal whose user types must not be waited for.
constexpr std::chrono::milliseconds answer_patience(300);

/// Whether the locale's encoding is UTF-8.
bool is_utf8() {
    const locale_t locale = newlocale(LC_CTYPE_MASK, "", nullptr);
    if (locale == nullptr) return false;
    const bool result = std::string_view(nl_langinfo_l(CODESET, locale)) == "UTF-8";
    freelocale(locale);
    return result;
}

/// Queries support for a one-pixel picture in kitty's protocol. tmux and screen take it for a
/// title.
constexpr const char* kitty_question = "\x1b_Gi=4211,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\";

/// Queries the device attributes, which every terminal reports, so that the last answer always
/// comes: "ESC [ ? 6 2 ; 4 c", 4 for sixels.
constexpr const char* attributes_question = "\x1b[c";

bool is_shared(const TerminalNames& names) {
    return names.is_shared || names.kind.starts_with("screen") || names.kind.starts_with("tmux");
}

/// Milliseconds until then, or 0 if it is past.
int milliseconds_until(std::chrono::steady_clock::time_point then) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(then - std::chrono::steady_clock::now());
    return static_cast<int>(std::max(left, std::chrono::milliseconds(0)).count());
}

std::string answers(int terminal, const std::string& questions) {
    termios usual{};
    if (tcgetpgrp(terminal) != getpgrp() || tcgetattr(terminal, &usual) != 0) return "";
    termios raw = usual;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    if (tcsetattr(terminal, TCSANOW, &raw) != 0) return "";
    std::string text;
    if (write(terminal, questions.data(), questions.size()) > 0) {
        const auto deadline = std::chrono::steady_clock::now() + answer_patience;
        pollfd waited{terminal, POLLIN, 0};
        while (poll(&waited, 1, milliseconds_until(deadline)) == 1) {
            char bytes[256];
            const ssize_t got = read(terminal, bytes, sizeof(bytes));
            if (got <= 0) break;
            text.append(bytes, static_cast<std::size_t>(got));
            const std::size_t attributes = text.find("\x1b[?");
            if (attributes != text.npos && text.find('c', attributes) != text.npos) break;
        }
    }
    tcsetattr(terminal, TCSANOW, &usual);
    return text;
}

/// Whether the attributes include 4.
bool has_sixels(const std::string& text) {
    const std::size_t start = text.find("\x1b[?");
    if (start == text.npos) return false;
    const std::string list = ";" + text.substr(start + 3, text.find('c', start) - start - 3) + ";";
    return list.find(";4;", list.find(';', 1)) != list.npos;
}

}  // namespace

TerminalSize terminal_size() {
    TerminalSize result;
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0) return result;
    if (size.ws_col > 0) result.columns = size.ws_col;
    if (size.ws_row > 0) result.rows = size.ws_row;
    if (size.ws_xpixel >= result.columns && size.ws_ypixel >= result.rows) {
        result.cell_width = size.ws_xpixel / result.columns;
        result.cell_height = size.ws_ypixel / result.rows;
    }
    return result;
}

Terminal find_terminal(const TerminalNames& names, bool asks_it) {
    Terminal terminal;
    terminal.size = terminal_size();
    terminal.true_color =
        names.colors == "truecolor" || names.colors == "24bit" || names.kind.ends_with("-direct");
    const bool is_plain = names.kind.empty() || names.kind == "dumb" || names.without_colors;
    terminal.has_blocks = !is_plain && is_utf8();
    if (is_plain || !asks_it) return terminal;
    const FileDescriptor device(open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC));
    if (!device) return terminal;
    const std::string kitty = is_shared(names) ? "" : kitty_question;
    const std::string text = answers(device.number(), kitty + attributes_question);
    terminal.shows_kitty = text.find("_Gi=4211;OK") != text.npos;
    terminal.shows_sixels = has_sixels(text);
    return terminal;
}

}  // namespace rt
