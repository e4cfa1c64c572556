// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the journal reader returns records that fit the picture, or
// throws rt::Error. CRCs are fixed first, or every record would be rejected.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/journals/.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include "host/base/error.h"
#include "host/journal/journal_format.h"

namespace {

/// Gives the records correct CRCs.
void mend(std::string& bytes) {
    for (std::size_t at = rt::journal_magic.size(); at + 12 <= bytes.size();) {
        std::uint32_t head[3];
        std::memcpy(head, &bytes[at], sizeof(head));
        if (head[1] > bytes.size() - at - 12) return;
        const auto body = std::as_bytes(std::span(bytes)).subspan(at + 12, head[1]);
        head[2] = rt::record_crc(static_cast<rt::RecordKind>(head[0]), body);
        std::memcpy(&bytes[at], head, sizeof(head));
        at += 12 + head[1];
    }
}

template <typename T>
void read_all(rt::JournalReader& reader) {
    rt::KnownPixels<T> known = rt::read_known_pixels<T>(reader);
    const auto pixels = static_cast<std::size_t>(reader.header().picture.region.pixels());
    if (known.is_rendered.size() != pixels) __builtin_trap();
    if (known.film.rgb.size() != 3 * pixels) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (size > 0 && data[size - 1] % 4 != 0) mend(bytes);
    std::istringstream stream(bytes);
    try {
        rt::JournalReader reader(stream, size);
        if (reader.header().picture.region.pixels() > 1 << 14) return 0;
        if (reader.header().is_double()) {
            read_all<double>(reader);
        } else {
            read_all<float>(reader);
        }
        if (reader.good_bytes() > size) __builtin_trap();
    } catch (const rt::Error&) {
    }
    return 0;
}
