// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace rt {

/// How a terminal shows pictures; automatic: what it reports, else half blocks.
enum class PreviewMode { automatic, half, kitty, sixel };

struct TevAddress {
    std::string host = "127.0.0.1", port = "14158";
};

/// What the environment says about the terminal.
struct TerminalNames {
    std::string kind;             ///< TERM
    std::string colors;           ///< COLORTERM
    bool without_colors = false;  ///< NO_COLOR
    bool is_shared = false;       ///< by tmux or screen: TMUX or STY is set
};

/// Where a picture is shown while it is rendered.
struct ViewSettings {
    std::optional<PreviewMode> preview;  ///< in the terminal
    std::optional<TevAddress> tev;
    bool window = false;
    TerminalNames terminal;

    bool any() const { return preview || tev || window; }
};

}  // namespace rt
