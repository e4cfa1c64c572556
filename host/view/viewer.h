// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"
#include "host/render/rect.h"

namespace rt {

/// Shows a picture while it is rendered. All calls come from one thread; none throws.
class Viewer {
   public:
    virtual ~Viewer() = default;

    /// A picture of this size in pixels begins, all black, in place of the one before.
    virtual void begin(int width, int height) = 0;

    /// The picture so far, and the parts changed since the last call.
    virtual void update(const Picture& picture, std::span<const Rect> changed) = 0;

    /// The final picture.
    virtual void finish(const Picture& picture) = 0;

    /// Called ten times a second from `begin` on, with the picture so far.
    virtual void tick(const Picture&) {}

    /// After `finish`: whether it still wants ticks, as a window does until it is closed.
    virtual bool is_open() const { return false; }
};

/// Receives what a viewer has to tell, such as why it stops.
using Say = std::function<void(const std::string& line)>;

struct TevAddress {
    std::string host = "127.0.0.1", port = "14158";
};

/// What the environment says about the terminal.
struct TerminalNames {
    std::string kind;             ///< TERM
    bool without_colors = false;  ///< NO_COLOR
};

/// Where a picture is shown while it is rendered.
struct ViewSettings {
    bool preview = false;  ///< in the terminal
    std::optional<TevAddress> tev;
    bool window = false;
    TerminalNames terminal;
};

/// Creates the viewers of a picture called `name`. `say` receives why one cannot be created, and
/// later errors, these on another thread.
std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  const Say& say);

/// Why this program has no windows; empty if it has.
std::string why_no_windows();

/// Crops a 3-channel picture to `part`, which must lie within it.
Picture cut(const Picture& picture, const Rect& part);

/// libmirrorball_sdl.so, which links SDL 2. Program and module are built together.
struct WindowModule {
    using Encode = std::function<std::vector<std::uint8_t>(const Picture&, const Rect&)>;

    static constexpr std::uint32_t current_version = 1;

    std::uint32_t version;
    /// A window that fills in as parts of the picture arrive, 8 bits a channel as `encode` gives
    /// them, with the percentage done in its title. Escape, q or its close button close it;
    /// rendering continues without it.
    std::unique_ptr<Viewer> (*make)(std::string name, Encode encode, Say say);
};

}  // namespace rt
