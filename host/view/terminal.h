// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/view/view_settings.h"

namespace rt {

struct TerminalSize {
    int columns = 80, rows = 24;
    int cell_width = 8, cell_height = 16;  ///< pixels
};

/// The size of stderr's terminal; defaults as above for what it does not report.
TerminalSize terminal_size();

/// What a terminal can show, and how large it is.
struct Terminal {
    TerminalSize size;
    bool shows_kitty = false;  ///< it reported kitty's graphics protocol
    bool shows_sixels = false;
    bool true_color = false;
    bool has_blocks = false;  ///< non-ASCII characters and colors
};

/// Queries stderr's terminal for what it can show, waiting 300 ms for an answer; skipped if this
/// process is not in the foreground.
Terminal ask_terminal(const TerminalNames& names);

}  // namespace rt
