// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include "host/lower.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

struct Mode {
    const char* name;
    PreviewMode mode;
};

constexpr Mode modes[] = {{"auto", PreviewMode::automatic},
                          {"half", PreviewMode::half},
                          {"kitty", PreviewMode::kitty},
                          {"sixel", PreviewMode::sixel}};

const Mode* find_mode(const std::string& text) {
    for (const Mode& mode : modes) {
        if (text == mode.name) return &mode;
    }
    return nullptr;
}

/// "HOST:PORT", "HOST", ":PORT" or "[IPv6]:PORT"; missing parts default to tev's.
TevAddress parse_tev_address(const std::string& text) {
    TevAddress address;
    const std::size_t bracket = text.find(']');
    const std::size_t colon = text.find(':', bracket == std::string::npos ? 0 : bracket);
    std::string host = text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    if (!host.empty()) address.host = host;
    if (colon != std::string::npos && colon + 1 < text.size()) {
        address.port = text.substr(colon + 1);
    }
    return address;
}

/// Whether a word is an address rather than a scene: no file, and without a scene's ending.
bool is_tev_address(const std::string& text) {
    std::error_code ignored;
    if (text.empty() || text.starts_with('-') || std::filesystem::exists(text, ignored)) {
        return false;
    }
    if (text.find(':') != std::string::npos) return true;
    constexpr std::string_view endings[] = {".json", ".nff", ".obj", ".ply"};
    return text.find('/') == std::string::npos &&
           std::ranges::find(endings, lower_ending(text)) == std::end(endings);
}

}  // namespace

void add_view_options(const CommandLine& verb, ViewSettings& view) {
    view.terminal.kind = environment("TERM");
    view.terminal.colors = environment("COLORTERM");
    view.terminal.without_colors = !environment("NO_COLOR").empty();
    view.terminal.is_shared = !environment("TMUX").empty() || !environment("STY").empty();
    verb.optional_value(
        "--preview", "auto|half|kitty|sixel",
        "show the picture in the terminal as it is rendered, by half blocks or one of the "
        "terminals' picture protocols (auto, default: the best that the terminal has)",
        "auto", [](const std::string& text) { return find_mode(text) != nullptr; },
        [&view](const std::string& text) {
            const Mode* const mode = find_mode(text);
            if (mode == nullptr) {
                refuse_choice("--preview", text, {"auto", "half", "kitty", "sixel"});
            }
            view.preview = mode->mode;
        });
    verb.flag("--show", view.window,
              "show it in a window as it is rendered; Escape or q closes it, and the command ends "
              "when it is closed");
    const TevAddress usual;
    verb.optional_value(
        "--tev", "HOST[:PORT]",
        "show it in the image viewer tev as it is rendered (default: 127.0.0.1:14158)",
        usual.host + ":" + usual.port, is_tev_address,
        [&view](const std::string& text) { view.tev = parse_tev_address(text); });
}

}  // namespace rt
