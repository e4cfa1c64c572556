// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include "host/base/files.h"
#include "host/view/viewer.h"

namespace rt {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers go into packets as they are");

constexpr char create_image = 4, update_image_v3 = 6;
constexpr timeval reading_patience{2, 0};
constexpr int most_pixels = 1 << 20;  ///< of a packet

/// A packet of tev's protocol (its Ipc.cpp): total length, a byte for the kind, then values in
/// little-endian order; strings end with a NUL.
class Packet {
   public:
    explicit Packet(char kind) {
        add(std::uint32_t{0});
        add(kind);
    }
    template <typename T>
    void add(T value) {
        const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
    }
    void add(const std::string& text) {
        const auto* const bytes = reinterpret_cast<const std::byte*>(text.c_str());
        bytes_.insert(bytes_.end(), bytes, bytes + text.size() + 1);
    }
    void add(std::span<const float> values) {
        const auto bytes = std::as_bytes(values);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    std::vector<std::byte> take() {
        const auto size = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof(size));
        return std::move(bytes_);
    }

   private:
    std::vector<std::byte> bytes_;
};

void add_channels(Packet& packet) {
    for (const char* name : {"R", "G", "B"}) packet.add(std::string(name));
}

/// Returns an open connection; on failure `why` tells the reason.
FileDescriptor connect_to(const TevAddress& address, std::string& why) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int status = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
    if (status != 0) {
        why = ::gai_strerror(status);
        return FileDescriptor();
    }
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
    for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
        FileDescriptor socket(::socket(at->ai_family, SOCK_STREAM | SOCK_CLOEXEC, at->ai_protocol));
        if (!socket) continue;
        ::setsockopt(socket.number(), SOL_SOCKET, SO_SNDTIMEO, &reading_patience,
                     sizeof(reading_patience));  // of connecting, too
        if (::connect(socket.number(), at->ai_addr, at->ai_addrlen) == 0) return socket;
        why = std::strerror(errno == EINPROGRESS ? ETIMEDOUT : errno);
    }
    return FileDescriptor();
}

std::vector<std::byte> create_packet(const std::string& name, int width, int height) {
    Packet packet(create_image);
    packet.add(char{1});  // bring it to the front
    packet.add(name);
    packet.add(std::int32_t{width});
    packet.add(std::int32_t{height});
    packet.add(std::int32_t{3});
    add_channels(packet);
    return packet.take();
}

std::vector<std::byte> update_packet(const std::string& name, const Picture& picture,
                                     const Rect& part) {
    Packet packet(update_image_v3);
    packet.add(char{0});
    packet.add(name);
    packet.add(std::int32_t{3});
    add_channels(packet);
    for (const int number : {part.x, part.y, part.width, part.height}) {
        packet.add(std::int32_t{number});
    }
    for (const int offset : {0, 1, 2}) packet.add(std::int64_t{offset});
    for (int channel = 0; channel < 3; ++channel) packet.add(std::int64_t{3});  // strides
    packet.add(std::span<const float>(cut(picture, part).pixels));
    return packet.take();
}

/// Sends the picture to the viewer tev, until a stop signal comes. If tev cannot be reached, or
/// reads nothing for two seconds, reports that once and sends no more of that picture.
class TevViewer : public Viewer {
   public:
    TevViewer(TevAddress address, std::string name, Say say, const StopFlag& stop)
        : address_(std::move(address)), name_(std::move(name)), say_(std::move(say)), stop_(stop) {}

    void begin(int width, int height) override {
        std::string why;
        if (!socket_) socket_ = connect_to(address_, why);
        if (socket_) return send(create_packet(name_, width, height));
        say_(fmt::format("cannot reach tev at {}:{} ({}); start tev first", address_.host,
                         address_.port, why));
    }

    void update(const Picture& picture, std::span<const Rect> changed) override {
        if (!socket_) return;
        for (const Rect& part : changed) {
            const int rows = std::max(most_pixels / part.width, 1);
            for (int y = 0; y < part.height; y += rows) {
                send(update_packet(
                    name_, picture,
                    {part.x, part.y + y, part.width, std::min(rows, part.height - y)}));
            }
        }
    }

    void finish(const Picture& picture) override {
        update(picture, std::array{Rect{0, 0, picture.width, picture.height}});
    }

   private:
    void send(std::span<const std::byte> packet) {
        while (socket_ && !packet.empty() && stop_ == 0) {
            const ssize_t count =
                ::send(socket_.number(), packet.data(), packet.size(), MSG_NOSIGNAL);
            if (count > 0) {
                packet = packet.subspan(static_cast<std::size_t>(count));
            } else if (errno != EINTR) {
                say_(errno == EAGAIN
                         ? "tev does not respond; continuing without it"
                         : fmt::format("lost the connection to tev ({}); continuing without it",
                                       std::strerror(errno)));
                socket_ = FileDescriptor();
            }
        }
    }

    const TevAddress address_;
    const std::string name_;
    const Say say_;
    const StopFlag& stop_;
    FileDescriptor socket_;
};

}  // namespace

std::unique_ptr<Viewer> make_tev_viewer(const TevAddress& address, const std::string& name,
                                        const Say& say, const StopFlag& stop) {
    return std::make_unique<TevViewer>(address, name, say, stop);
}

}  // namespace rt
