// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

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

}  // namespace rt
