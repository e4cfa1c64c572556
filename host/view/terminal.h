// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/view/view_settings.h"

namespace rt {

struct TerminalSize {
    int columns = 80, rows = 24;
    int cell_width = 8, cell_height = 16;  ///< pixels
};

/// Of stderr's terminal; what it does not say is as above.
TerminalSize terminal_size();

/// What a terminal can show, and how large it is.
struct Terminal {
    TerminalSize size;
    bool shows_kitty = false;  ///< it said that it has kitty's graphics protocol
    bool shows_sixels = false;
    bool true_color = false;
    bool has_blocks = false;  ///< characters beyond ASCII, and colors
};

/// The terminal of stderr, asked for what it can show. It gets a third of a second to answer; not
/// asked where this process is not in front.
Terminal ask_terminal(const TerminalNames& names);

}  // namespace rt
