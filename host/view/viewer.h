// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"
#include "host/render/rect.h"
#include "host/render/tile_queue.h"

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

    /// Called ten times a second from `begin` on.
    virtual void tick() {}

    /// After `finish`: whether it still wants ticks, as a window does until it is closed.
    virtual bool is_open() const { return false; }
};

/// Receives what a viewer has to tell, such as why it stops.
using Say = std::function<void(const std::string& line)>;

struct TevAddress {
    std::string host = "127.0.0.1", port = "14158";
};

/// Where a picture is shown while it is rendered.
struct ViewSettings {
    bool preview = false;  ///< in the terminal
    std::optional<TevAddress> tev;
    bool window = false;
    std::string terminal;         ///< TERM
    bool without_colors = false;  ///< NO_COLOR
};

struct TerminalSize {
    int columns = 80, rows = 24;
};

/// The size of stderr's terminal; defaults as above for what it does not report.
TerminalSize terminal_size();

/// A viewer that draws in stderr's terminal, or null: `say` receives why.
std::unique_ptr<Viewer> make_preview(const ViewSettings& settings, Encoding encoding,
                                     const Say& say);

/// A viewer that sends the picture to tev, unless `stop` is set.
std::unique_ptr<Viewer> make_tev_viewer(const TevAddress& address, const std::string& name,
                                        const Say& say, const StopFlag& stop);

/// Creates the viewers of a picture called `name`. `say` receives why one cannot be created, and
/// later errors, these on another thread.
std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  const Say& say, const StopFlag& stop);

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

/// Passes a picture in progress to viewers, calling them all on its own thread: one that is slow or
/// hangs never delays the render.
class LivePicture {
   public:
    /// `patience`: how long `finish` waits for viewers that hang.
    explicit LivePicture(std::vector<std::unique_ptr<Viewer>> viewers,
                         std::chrono::milliseconds patience = std::chrono::seconds(5));
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    /// Begins a picture of this size, in place of the previous one, if any.
    void begin(int width, int height);

    /// Adds the pixels of a rectangle, three numbers each, row by row; callable from any thread.
    void put(const Rect& part, std::vector<float> rgb);

    /// Shows the final picture.
    void finish(Picture picture);

    /// After `finish`: whether all windows are closed and viewers have the picture.
    bool is_over();

   private:
    struct Part {
        Rect rect;
        std::vector<float> rgb;
    };

    void run(const std::stop_token& stop);
    void add(const Part& part);
    void show_last(Picture picture);
    void tell(bool begins, const std::vector<Rect>& parts);
    bool any_open() const;

    const std::vector<std::unique_ptr<Viewer>> viewers_;
    const std::chrono::milliseconds patience_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;  ///< not yet sent to viewers
    bool has_begun_ = false;   ///< begun, but not yet sent to viewers
    std::optional<Picture> final_;
    bool is_shown_ = false;  ///< the final picture is
    bool is_over_ = false;   ///< it is, and no viewer wants anything more
    Picture shown_;          ///< so far; used only by the thread
    std::jthread thread_;
};

}  // namespace rt
