// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace rt {

/// FNV-1a, 64 bits, over 8-byte words and then bytes: a fingerprint, not a defense.
class Hasher {
   public:
    void add_bytes(std::span<const std::byte> bytes) {
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

    template <typename N>
    requires std::is_arithmetic_v<N>
    void add(N number) { add_bytes(std::as_bytes(std::span(&number, 1))); }

    /// Length first, so that "ab", "c" differs from "a", "bc".
    void add(std::string_view text) {
        add(text.size());
        add_bytes(std::as_bytes(std::span(text)));
    }

    std::uint64_t value() const { return state_; }

   private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// 16 hexadecimal digits.
inline std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace rt
