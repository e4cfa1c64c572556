// SPDX-License-Identifier: Apache-2.0
#include <SDL.h>
#include <SDL_syswm.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "host/view/viewer.h"

namespace {

using rt::Picture;
using rt::Rect;

/// Xlib ends the program when it loses its server, unless these functions take over: then it sets
/// `is_lost`, which must outlive the window.
void survive_loss(SDL_Window* window, bool& is_lost) {
#ifdef SDL_VIDEO_DRIVER_X11
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (SDL_GetWindowWMInfo(window, &info) == SDL_FALSE || info.subsystem != SDL_SYSWM_X11) return;
    void* const xlib = SDL_LoadObject("libX11.so.6");  // which SDL has loaded
    const auto find = [&](auto* declared, const char* name) {
        return reinterpret_cast<decltype(declared)>(SDL_LoadFunction(xlib, name));
    };
    const auto on_error = find(&XSetErrorHandler, "XSetErrorHandler");
    const auto on_io_error = find(&XSetIOErrorHandler, "XSetIOErrorHandler");
    const auto on_exit = find(&XSetIOErrorExitHandler, "XSetIOErrorExitHandler");
    if (on_error == nullptr || on_io_error == nullptr || on_exit == nullptr) return;
    on_error([](Display*, XErrorEvent*) { return 0; });
    on_io_error([](Display*) { return 0; });
    const auto remember = [](Display*, void* lost) { *static_cast<bool*>(lost) = true; };
    on_exit(info.info.x11.display, remember, &is_lost);
#endif
}

class SdlWindow : public rt::Viewer {
   public:
    SdlWindow(std::string name, rt::WindowModule::Encode encode, rt::Say say)
        : name_(std::move(name)), encode_(std::move(encode)), say_(std::move(say)) {}
    ~SdlWindow() override { close(); }

    void begin(int width, int height) override {
        if (!was_closed_ && window_ == nullptr) open(width, height);
        if (!is_open()) return;
        if (width != width_ || height != height_) make_texture(width, height);
        pixels_shown_ = 0;
        const auto values = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        put({width, height, 3, std::vector<float>(values)}, {0, 0, width, height});
        present();
    }

    void update(const Picture& picture, std::span<const Rect> changed) override {
        if (!is_open()) return;
        for (const Rect& part : changed) {
            put(picture, part);
            pixels_shown_ += part.pixels();
        }
        const auto pixels = std::int64_t{width_} * height_;
        const auto percent = 100 * std::min(pixels_shown_, pixels) / pixels;
        SDL_SetWindowTitle(window_, (name_ + " - " + std::to_string(percent) + " %").c_str());
        present();
    }

    void finish(const Picture& picture) override {
        if (!is_open()) return;
        put(picture, {0, 0, picture.width, picture.height});
        SDL_SetWindowTitle(window_, name_.c_str());
        present();
    }

    /// Handles window events; redraws what was covered.
    void tick() override {
        bool any = false;
        SDL_Event event;
        while (is_open() && SDL_PollEvent(&event) != 0) {
            any = true;
            const bool is_key = event.type == SDL_KEYDOWN;
            const SDL_Keycode key = is_key ? event.key.keysym.sym : SDLK_UNKNOWN;
            if (event.type == SDL_QUIT || key == SDLK_ESCAPE || key == SDLK_q) return close();
        }
        if (any && is_open()) present();
        if (is_lost_ && !std::exchange(was_closed_, true)) {
            say_("lost the X server; continuing without a window");
        }
    }

    bool is_open() const override { return window_ != nullptr && !was_closed_ && !is_lost_; }

   private:
    void open(int width, int height) {
        SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
        SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
        const bool has_started = SDL_Init(SDL_INIT_VIDEO) == 0;
        const char* const driver = SDL_GetCurrentVideoDriver();
        // Without a display, SDL draws to memory: nobody could close that window.
        const bool has_screen = driver != nullptr && driver != std::string_view("offscreen");
        if (has_started && has_screen && make_window(width, height)) return;
        say_(std::string("no window: ") +
             (has_started && !has_screen ? "there is no display; set DISPLAY or WAYLAND_DISPLAY"
                                         : SDL_GetError()));
        close();
    }

    bool make_window(int width, int height) {
        SDL_Rect screen{0, 0, 1024, 768};
        SDL_GetDisplayUsableBounds(0, &screen);
        const double scale = std::min({1.0, 0.9 * screen.w / width, 0.9 * screen.h / height});
        window_ = SDL_CreateWindow(name_.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                   std::max(static_cast<int>(width * scale), 1),
                                   std::max(static_cast<int>(height * scale), 1),
                                   SDL_WINDOW_RESIZABLE | SDL_WINDOW_HIDDEN);
        if (window_ == nullptr) return false;
        survive_loss(window_, is_lost_);
        SDL_ShowWindow(window_);
        // A graphics driver may have threads and connections of its own, which are lost, too.
        renderer_ = SDL_CreateRenderer(window_, -1, SDL_RENDERER_SOFTWARE);
        return renderer_ != nullptr && make_texture(width, height);
    }

    bool make_texture(int width, int height) {
        if (texture_ != nullptr) SDL_DestroyTexture(texture_);
        SDL_RenderSetLogicalSize(renderer_, width, height);
        texture_ = SDL_CreateTexture(renderer_, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING,
                                     width, height);
        width_ = width;
        height_ = height;
        return texture_ != nullptr;
    }

    void put(const Picture& picture, const Rect& part) {
        const SDL_Rect box{part.x, part.y, part.width, part.height};
        SDL_UpdateTexture(texture_, &box, encode_(picture, part).data(), 3 * part.width);
    }

    void present() {
        SDL_RenderClear(renderer_);
        SDL_RenderCopy(renderer_, texture_, nullptr, nullptr);
        SDL_RenderPresent(renderer_);
    }

    void close() {
        if (!is_lost_ && !was_closed_) SDL_Quit();
        was_closed_ = true;
    }

    const std::string name_;
    const rt::WindowModule::Encode encode_;
    const rt::Say say_;
    SDL_Window* window_ = nullptr;  ///< SDL_Quit destroys all of these
    SDL_Renderer* renderer_ = nullptr;
    SDL_Texture* texture_ = nullptr;
    int width_ = 0, height_ = 0;  ///< of the texture
    std::int64_t pixels_shown_ = 0;
    bool is_lost_ = false;     ///< the X server: SDL must not be called any more
    bool was_closed_ = false;  ///< or could not be opened, or was reported as lost
};

std::unique_ptr<rt::Viewer> make(std::string name, rt::WindowModule::Encode encode, rt::Say say) {
    return std::make_unique<SdlWindow>(std::move(name), std::move(encode), std::move(say));
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const void* mirrorball_module() {
    static constexpr rt::WindowModule module{rt::WindowModule::current_version, make};
    return &module;
}
