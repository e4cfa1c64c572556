// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/file_descriptor.h"
#include "host/view/view_settings.h"
#include "host/view/viewer.h"

namespace rt {

/// The packets of tev's protocol (its Ipc.cpp): total length, a byte for the kind, then values in
/// little-endian order; strings end with a NUL.
std::vector<std::byte> tev_create_image(const std::string& name, int width, int height);
std::vector<std::byte> tev_update_image(const std::string& name, const Picture& picture,
                                        const Rect& part);

/// Sends the picture to the viewer tev. If tev cannot be reached, or reads nothing for two seconds,
/// reports that once and sends no more.
class TevViewer : public Viewer {
   public:
    using Say = std::function<void(const std::string& line)>;

    TevViewer(TevAddress address, std::string name, Say say);

    void begin(int width, int height) override;
    void update(const Picture& picture, std::span<const Rect> changed) override;
    void finish(const Picture& picture) override;

   private:
    void send(const std::vector<std::byte>& packet);
    void send_part(const Picture& picture, const Rect& part);
    void give_up(const std::string& why);

    const TevAddress address_;
    const std::string name_;
    const Say say_;
    FileDescriptor socket_;
    bool has_failed_ = false;
};

}  // namespace rt
