// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/view/viewer.h"

namespace rt {

struct TerminalSize {
    int columns = 80, rows = 24;
};

/// The size of stderr's terminal; defaults as above for what it does not report.
TerminalSize terminal_size();

/// Whether a terminal of these names, in this locale, shows colors and characters beyond ASCII.
bool has_half_blocks(const TerminalNames& names);

/// Draws the picture in stderr's terminal in upper half blocks, two pixels each, scaled down to
/// fit but never up, redrawing it in the same place.
class TerminalViewer : public Viewer {
   public:
    explicit TerminalViewer(Encoding encoding) : encoding_(encoding) {}

    void begin(int width, int height) override;
    void update(const Picture& picture, std::span<const Rect>) override { draw(picture); }
    void finish(const Picture& picture) override { draw(picture); }

   private:
    void draw(const Picture& picture);

    const Encoding encoding_;
    int width_ = 0, height_ = 0;  ///< pixels that are drawn
    bool is_drawn_ = false;
};

}  // namespace rt
