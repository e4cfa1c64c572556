// SPDX-License-Identifier: Apache-2.0
#include "host/view/viewer.h"

#include <unistd.h>

#include <cstddef>

#include "host/base/error.h"
#include "host/base/files.h"
#include "host/view/terminal_viewer.h"
#include "host/view/tev_viewer.h"

namespace rt {

namespace {

const WindowModule& load_windows() {
    return *static_cast<const WindowModule*>(
        load_module({"libmirrorball_sdl.so", WindowModule::current_version, "windows",
                     "--show requires libsdl2-2.0-0, and mirrorball built with libsdl2-dev"},
                    ExitCode::device));
}

std::unique_ptr<Viewer> make_window(const std::string& name, Encoding encoding, const Say& say) {
    const auto encode = [encoding](const Picture& picture, const Rect& part) {
        return encode_8bit(cut(picture, part), encoding);
    };
    try {
        return load_windows().make(name, encode, say);
    } catch (const Error& error) {
        say(std::string("no window: ") + error.what());
        return nullptr;
    }
}

std::unique_ptr<Viewer> make_preview(const TerminalNames& names, Encoding encoding,
                                     const Say& say) {
    if (isatty(STDERR_FILENO) != 1) {
        say("no preview: standard error is not a terminal");
    } else if (!has_half_blocks(names)) {
        say("no preview: the terminal does not support colors or UTF-8");
    } else {
        return std::make_unique<TerminalViewer>(encoding);
    }
    return nullptr;
}

}  // namespace

std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  const Say& say) {
    std::vector<std::unique_ptr<Viewer>> viewers;
    if (settings.tev) viewers.push_back(std::make_unique<TevViewer>(*settings.tev, name, say));
    if (settings.window) viewers.push_back(make_window(name, encoding, say));
    if (settings.preview) viewers.push_back(make_preview(settings.terminal, encoding, say));
    std::erase(viewers, nullptr);
    return viewers;
}

std::string why_no_windows() try {
    load_windows();
    return "";
} catch (const Error& error) {
    return error.what();
}

Picture cut(const Picture& picture, const Rect& part) {
    Picture result{part.width, part.height, 3, {}};
    const auto row = 3 * static_cast<std::ptrdiff_t>(part.width);
    for (int y = part.y; y < part.y + part.height; ++y) {
        const auto from = picture.pixels.begin() + 3 * (std::ptrdiff_t{y} * picture.width + part.x);
        result.pixels.insert(result.pixels.end(), from, from + row);
    }
    return result;
}

}  // namespace rt
