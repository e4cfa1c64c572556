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

/// What stderr's terminal is by its names and size. With `asks_it`, unless this process is in the
/// background, the terminal itself is queried for graphics protocols: up to 300 ms.
Terminal find_terminal(const TerminalNames& names, bool asks_it);

}  // namespace rt
