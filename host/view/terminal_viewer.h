// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/image/encoding.h"
#include "host/view/terminal.h"
#include "host/view/view_settings.h"
#include "host/view/viewer.h"

namespace rt {

/// Draws the picture in stderr's terminal, scaled down to fit but never up, redrawing it in the
/// same place.
class TerminalViewer : public Viewer {
   public:
    /// `mode` must not be automatic.
    TerminalViewer(const Terminal& terminal, PreviewMode mode, Encoding encoding)
        : terminal_(terminal), mode_(mode), encoding_(encoding) {}

    void begin(int width, int height) override;
    void update(const Picture& picture, std::span<const Rect> changed) override;
    void finish(const Picture& picture) override;

   private:
    std::string drawn(const Picture& picture) const;
    void draw(const Picture& picture);

    const Terminal terminal_;
    const PreviewMode mode_;
    const Encoding encoding_;
    int columns_ = 0, rows_ = 0;  ///< cells that it takes
    int width_ = 0, height_ = 0;  ///< pixels that are sent
    bool is_drawn_ = false;
};

/// Resolves `automatic`: the graphics protocol the terminal reported, else half blocks.
PreviewMode preview_mode(const Terminal& terminal, PreviewMode asked);

}  // namespace rt
