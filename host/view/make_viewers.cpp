// SPDX-License-Identifier: Apache-2.0
#include "host/view/make_viewers.h"

#include <unistd.h>

#include <utility>

#include "host/view/terminal.h"
#include "host/view/terminal_viewer.h"
#include "host/view/tev_viewer.h"
#include "host/view/window_viewer.h"

namespace rt {

std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  std::function<void(const std::string&)> say) {
    std::vector<std::unique_ptr<Viewer>> viewers;
    if (settings.tev) viewers.push_back(std::make_unique<TevViewer>(*settings.tev, name, say));
    if (settings.window) viewers.push_back(std::make_unique<WindowViewer>(name, encoding, say));
    if (!settings.preview) return viewers;
    if (isatty(STDERR_FILENO) != 1) {
        say("no preview: standard error is not a terminal");
        return viewers;
    }
    const bool asks_it = *settings.preview == PreviewMode::automatic;
    const Terminal terminal = find_terminal(settings.terminal, asks_it);
    const PreviewMode mode = preview_mode(terminal, *settings.preview);
    if (mode == PreviewMode::half && !terminal.has_blocks) {
        say("no preview: the terminal does not support colors or UTF-8");
        return viewers;
    }
    viewers.push_back(std::make_unique<TerminalViewer>(terminal, mode, encoding));
    return viewers;
}

}  // namespace rt
