// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"

#include <cstring>

namespace rt {

void Hasher::add_bytes(std::span<const std::byte> bytes) {
    constexpr std::uint64_t prime = 0x100000001b3u;
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + at, 8);
        state_ = (state_ ^ word) * prime;
        state_ ^= state_ >> 32;
    }
    for (; at < bytes.size(); ++at) {
        state_ = (state_ ^ static_cast<std::uint64_t>(bytes[at])) * prime;
    }
}

}  // namespace rt
