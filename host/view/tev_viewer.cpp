// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <utility>

#include "host/base/files.h"
#include "host/view/viewer.h"

namespace rt {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers go into packets as they are");

constexpr char create_image = 4, update_image_v3 = 6;
constexpr std::chrono::milliseconds reading_patience(2000), last_patience(10000), turn(100);
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

/// Waits until a socket can be written to.
bool is_writable(int socket, std::chrono::milliseconds longest) {
    pollfd waited{socket, POLLOUT, 0};
    return ::poll(&waited, 1, static_cast<int>(longest.count())) == 1;
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
        FileDescriptor socket(
            ::socket(at->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, at->ai_protocol));
        if (!socket) continue;
        int error = ::connect(socket.number(), at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            socklen_t size = sizeof(error);
            error = ETIMEDOUT;
            if (is_writable(socket.number(), reading_patience)) {
                ::getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &error, &size);
            }
        }
        if (error == 0) return socket;
        why = std::strerror(error);
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

/// Sends the picture to the viewer tev: in each tick, what tev reads in a tenth of a second. If tev
/// cannot be reached, reads nothing for two seconds, or lacks some of the picture ten seconds after
/// `finish`, reports that once and sends no more of that picture.
class TevViewer : public Viewer {
   public:
    TevViewer(TevAddress address, std::string name, Say say)
        : address_(std::move(address)), name_(std::move(name)), say_(std::move(say)) {}

    void begin(int width, int height) override {
        if (!socket_) {
            std::string why;
            socket_ = connect_to(address_, why);
            if (!socket_) {
                return give_up(fmt::format("cannot reach tev at {}:{} ({}); start tev first",
                                           address_.host, address_.port, why));
            }
        }
        last_sent_ = Clock::now();
        deadline_ = Clock::time_point::max();
        parts_.clear();
        const auto packet = create_packet(name_, width, height);
        packets_.insert(packets_.end(), packet.begin(), packet.end());
    }

    void update(const Picture&, std::span<const Rect> changed) override {
        for (const Rect& part : changed) note(part);
    }

    void finish(const Picture& picture) override {
        parts_.clear();
        note({0, 0, picture.width, picture.height});
        deadline_ = Clock::now() + last_patience;
    }

    void tick(const Picture& picture) override {
        if (!is_open()) {
            last_sent_ = Clock::now();
            return;
        }
        send(picture);
        if (!is_open()) return;
        const auto now = Clock::now();
        if (now - last_sent_ > reading_patience)
            return give_up("tev does not respond; continuing without it");
        if (now > deadline_) give_up("tev is too slow; continuing without it");
    }

    bool is_open() const override { return socket_ && (!packets_.empty() || !parts_.empty()); }

   private:
    using Clock = std::chrono::steady_clock;

    void note(const Rect& part) {
        if (!socket_) return;
        const int rows = std::max(most_pixels / part.width, 1);
        for (int y = 0; y < part.height; y += rows) {
            parts_.push_back({part.x, part.y + y, part.width, std::min(rows, part.height - y)});
        }
    }

    void send(const Picture& picture) {
        const auto end = Clock::now() + turn;
        while (is_open() && Clock::now() < end) {
            if (packets_.empty()) {
                packets_ = update_packet(name_, picture, parts_.front());
                parts_.pop_front();
            }
            const ssize_t count = ::send(socket_.number(), packets_.data() + sent_,
                                         packets_.size() - sent_, MSG_NOSIGNAL);
            if (count > 0) {
                last_sent_ = Clock::now();
                sent_ += static_cast<std::size_t>(count);
                if (sent_ < packets_.size()) continue;
                packets_.clear();
                sent_ = 0;
            } else if (errno == EAGAIN) {
                is_writable(socket_.number(), turn);
            } else if (errno != EINTR) {
                give_up(fmt::format("lost the connection to tev ({}); continuing without it",
                                    std::strerror(errno)));
            }
        }
    }

    void give_up(const std::string& why) {
        socket_ = FileDescriptor();
        packets_.clear();
        sent_ = 0;
        say_(why);
    }

    const TevAddress address_;
    const std::string name_;
    const Say say_;
    FileDescriptor socket_;
    std::deque<Rect> parts_;          ///< not yet in packets
    std::vector<std::byte> packets_;  ///< not yet sent, beginning at sent_
    std::size_t sent_ = 0;
    Clock::time_point last_sent_;
    Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace

std::unique_ptr<Viewer> make_tev_viewer(const TevAddress& address, const std::string& name,
                                        const Say& say) {
    return std::make_unique<TevViewer>(address, name, say);
}

}  // namespace rt
