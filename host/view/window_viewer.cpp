// SPDX-License-Identifier: Apache-2.0
#include "host/view/window_viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "host/view/cut.h"

namespace rt {

WindowViewer::WindowViewer(std::string name, Encoding encoding, Say say)
    : name_(std::move(name)), encoding_(encoding), say_(std::move(say)) {}

WindowViewer::~WindowViewer() { close(); }

/// Calls SDL's functions, which may lose the window.
void WindowViewer::call(const std::function<void()>& calls) {
    if (was_closed_ || sdl::survives(calls)) return;
    was_closed_ = true;
    window_ = nullptr;
    say_("lost the X server; continuing without a window");
}

void WindowViewer::open(int width, int height) {
    std::string why;
    sdl_ = sdl::load(why);
    if (sdl_ != nullptr) {
        call([&] { start(width, height); });
        if (was_closed_ || texture_ != nullptr) return;
        why = is_offscreen() ? "there is no display; set DISPLAY or WAYLAND_DISPLAY"
                             : sdl_->GetError();
    }
    say_("no window: " + why);
    close();
}

/// Without a display, SDL draws to memory: nobody could close that window.
bool WindowViewer::is_offscreen() const {
    const char* const driver = sdl_->GetCurrentVideoDriver();
    return driver != nullptr && std::string_view(driver) == "offscreen";
}

void WindowViewer::start(int width, int height) {
    sdl_->SetHint("SDL_NO_SIGNAL_HANDLERS", "1");
    sdl_->SetHint("SDL_VIDEO_ALLOW_SCREENSAVER", "1");
    if (sdl_->Init(sdl::video) != 0) return;
    sdl::expect_loss();
    if (is_offscreen()) return;
    sdl::Box screen{0, 0, 1024, 768};
    sdl_->GetDisplayUsableBounds(0, &screen);
    const double scale = std::min({1.0, 0.9 * screen.w / width, 0.9 * screen.h / height});
    window_ = sdl_->CreateWindow(name_.c_str(), sdl::centered, sdl::centered,
                                 std::max(static_cast<int>(width * scale), 1),
                                 std::max(static_cast<int>(height * scale), 1), sdl::resizable);
    if (window_ != nullptr) renderer_ = sdl_->CreateRenderer(window_, -1, 0);
    if (renderer_ != nullptr) make_texture(width, height);
}

void WindowViewer::make_texture(int width, int height) {
    if (texture_ != nullptr) sdl_->DestroyTexture(texture_);
    sdl_->RenderSetLogicalSize(renderer_, width, height);
    texture_ = sdl_->CreateTexture(renderer_, sdl::rgb24, sdl::streaming, width, height);
    texture_width_ = width;
    texture_height_ = height;
}

void WindowViewer::close() {
    if (window_ != nullptr) {
        call([&] {
            sdl_->DestroyWindow(window_);
            sdl_->Quit();
        });
    }
    was_closed_ = true;
    window_ = nullptr;
}

void WindowViewer::begin(int width, int height) {
    if (!was_closed_ && window_ == nullptr) open(width, height);
    if (was_closed_) return;
    if (width != texture_width_ || height != texture_height_) {
        call([&] { make_texture(width, height); });
        if (texture_ == nullptr) return close();
    }
    pixels_ = std::int64_t{width} * height;
    pixels_shown_ = 0;
    put({width, height, 3, std::vector<float>(static_cast<std::size_t>(3 * pixels_))},
        {0, 0, width, height});
    present();
}

void WindowViewer::put(const Picture& picture, const Rect& part) {
    const std::vector<std::uint8_t> rgb = encode_8bit(cut(picture, part), encoding_);
    const sdl::Box box{part.x, part.y, part.width, part.height};
    call([&] { sdl_->UpdateTexture(texture_, &box, rgb.data(), 3 * part.width); });
}

void WindowViewer::present() {
    call([&] {
        sdl_->RenderClear(renderer_);
        sdl_->RenderCopy(renderer_, texture_, nullptr, nullptr);
        sdl_->RenderPresent(renderer_);
    });
}

void WindowViewer::set_title(std::int64_t pixels) {
    pixels_shown_ = std::min(pixels, pixels_);
    const auto percent = 100 * pixels_shown_ / std::max<std::int64_t>(pixels_, 1);
    const std::string title = fmt::format("{} - {} %", name_, percent);
    call([&] { sdl_->SetWindowTitle(window_, title.c_str()); });
}

void WindowViewer::update(const Picture& picture, std::span<const Rect> changed) {
    if (window_ == nullptr) return;
    std::int64_t pixels = pixels_shown_;
    for (const Rect& part : changed) {
        put(picture, part);
        pixels += part.pixels();
    }
    set_title(pixels);
    present();
}

void WindowViewer::finish(const Picture& picture) {
    if (window_ == nullptr) return;
    put(picture, {0, 0, picture.width, picture.height});
    call([&] { sdl_->SetWindowTitle(window_, name_.c_str()); });
    present();
}

/// Handles window events; redraws what was covered.
void WindowViewer::tick(const Picture&) {
    sdl::Event event{};
    const auto poll = [&] {
        bool is_there = false;
        call([&] { is_there = sdl_->PollEvent(&event) != 0; });
        return is_there && window_ != nullptr;
    };
    bool any = false;
    while (window_ != nullptr && poll()) {
        any = true;
        const bool is_key = event.type == sdl::key_down;
        if (event.type == sdl::quit ||
            (is_key && (event.key.symbol == sdl::escape || event.key.symbol == 'q'))) {
            return close();
        }
    }
    if (any) present();
}

}  // namespace rt
