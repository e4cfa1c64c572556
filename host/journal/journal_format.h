// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/render/picture_spec.h"

// A journal (.mbj) stores the tiles of a picture as they are finished, so that an interrupted
// render can resume, and several machines can render shares of one picture.
//
// The file is 8 bytes of magic and then records, little-endian:
//     u32 kind, u32 bytes of the body, u32 CRC-32 of kind, bytes and body; body
// The header comes first, once; a `writer` record precedes what one process wrote. Later records
// override earlier ones. Nothing after the first bad record is read.
namespace rt {

inline constexpr std::string_view journal_magic = "MBJRNL03";  ///< the last two: its version

enum class RecordKind : std::uint32_t {
    header = 1,   ///< JSON: JournalHeader
    writer = 2,   ///< JSON: JournalWriterInfo
    tile = 3,     ///< i32 x, y, width, height in the picture; its pixels, three numbers each
    lost = 4,     ///< i32 x, y, width, height: no longer valid
    finished = 5  ///< the whole picture, or all its shares, is here; no body
};

/// What picture a journal belongs to.
struct JournalHeader {
    std::uint64_t key = 0;  ///< equal keys mean bit-identical pictures: picture_key
    PictureSpec picture;
    std::string shares;             ///< as to_string(Shares)
    std::string scene, scene_hash;  ///< as a picture's metadata have them
    /// To render it again: the file as given to the first writer, which may be empty, and what
    /// overrides the scene's light.
    std::string scene_file;
    std::optional<double> light_scale;
    std::optional<std::vector<double>> ambient_light;

    bool is_double() const { return picture.precision == Precision::float64; }
    std::size_t pixel_bytes() const { return 3 * (is_double() ? 8 : 4); }
    bool operator==(const JournalHeader&) const = default;
};

template <typename A, Of<JournalHeader> X>
void describe(A& a, X& x) {
    a("key", x.key, "");
    describe(a, x.picture);
    a("shares", x.shares, "");
    a("scene", x.scene, "");
    a("scene_hash", x.scene_hash, "");
    a("scene_file", x.scene_file, "");
    a("light_scale", x.light_scale, "");
    a("ambient_light", x.ambient_light, "");
}

/// Which process wrote the records that follow.
struct JournalWriterInfo {
    std::string host, device, version;
    int process = 0;
};

template <typename A, Of<JournalWriterInfo> X>
void describe(A& a, X& x) {
    a("host", x.host, "");
    a("device", x.device, "");
    a("version", x.version, "");
    a("process", x.process, "");
}

/// A record's CRC-32 (as in zlib).
std::uint32_t record_crc(RecordKind kind, std::span<const std::byte> body);

/// Appends a record to `bytes`.
void append_record(std::vector<std::byte>& bytes, RecordKind kind, std::span<const std::byte> body);

void append_header(std::vector<std::byte>& bytes, const JournalHeader& header);
void append_writer(std::vector<std::byte>& bytes, const JournalWriterInfo& writer);

/// Throws Error (ExitCode::input) describing the problem, without a file name.
JournalHeader parse_header(std::span<const std::byte> body);

/// Whatever fields can be parsed, for messages.
JournalWriterInfo parse_writer(std::span<const std::byte> body);

}  // namespace rt
