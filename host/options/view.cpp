// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include "host/base/lower.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

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

/// Whether a word is an address rather than a scene: no file, and without a scene's extension.
bool is_tev_address(const std::string& text) {
    std::error_code ignored;
    if (text.empty() || text.starts_with('-') || std::filesystem::exists(text, ignored)) {
        return false;
    }
    if (text.find(':') != std::string::npos) return true;
    constexpr std::string_view extensions[] = {".json", ".nff", ".obj", ".ply"};
    return text.find('/') == std::string::npos &&
           std::ranges::find(extensions, lower_extension(text)) == std::end(extensions);
}

}  // namespace

void add_view_options(const CommandLine& verb, ViewSettings& view) {
    view.terminal.kind = environment("TERM");
    view.terminal.colors = environment("COLORTERM");
    view.terminal.without_colors = !environment("NO_COLOR").empty();
    verb.flag("--preview", view.preview, "show the picture in the terminal while it renders");
    verb.flag("--show", view.window,
              "show the picture in a window while it renders; Escape or q closes the window, and "
              "the command ends when it is closed");
    const TevAddress usual;
    verb.optional_value(
        "--tev", "HOST[:PORT]",
        "show the picture in the image viewer tev while it renders (default: 127.0.0.1:14158)",
        usual.host + ":" + usual.port, is_tev_address,
        [&view](const std::string& text) { view.tev = parse_tev_address(text); });
}

}  // namespace rt
