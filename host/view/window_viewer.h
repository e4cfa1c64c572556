// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/image/encoding.h"
#include "host/view/sdl.h"
#include "host/view/viewer.h"

namespace rt {

/// An SDL 2 window that fills in as parts of the picture arrive, with the percentage done in its
/// title. Escape, q or its close button close it; rendering continues without it.
class WindowViewer : public Viewer {
   public:
    using Say = std::function<void(const std::string& line)>;

    WindowViewer(std::string name, Encoding encoding, Say say);
    ~WindowViewer() override;

    void begin(int width, int height) override;
    void update(const Picture& picture, std::span<const Rect> changed) override;
    void finish(const Picture& picture) override;
    void tick(const Picture& picture) override;
    bool is_open() const override { return window_ != nullptr; }

   private:
    void call(const std::function<void()>& calls);
    void open(int width, int height);
    bool is_offscreen() const;
    void start(int width, int height);
    void make_texture(int width, int height);
    void close();
    void put(const Picture& picture, const Rect& part);
    void present();
    void set_title(std::int64_t pixels);

    const std::string name_;
    const Encoding encoding_;
    const Say say_;
    const sdl::Library* sdl_ = nullptr;
    sdl::Window* window_ = nullptr;
    sdl::Renderer* renderer_ = nullptr;
    sdl::Texture* texture_ = nullptr;
    int texture_width_ = 0, texture_height_ = 0;
    std::int64_t pixels_ = 0, pixels_shown_ = 0;
    bool was_closed_ = false;  ///< or could not be opened, or lost its display
};

}  // namespace rt
