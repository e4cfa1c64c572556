// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/render/rect.h"

// A journal (.mbj) stores the tiles of a picture as they are finished, so that an interrupted
// render can resume, and several machines can render shares of one picture.
//
// The file is 8 bytes of magic and then records, little-endian:
//     u32 kind, u32 bytes of the body, u32 CRC-32 of kind, bytes and body; body
// The header comes first, once; a `writer` record precedes what one process wrote. Later records
// override earlier ones. Nothing after the first bad record is read.
namespace rt {

inline constexpr std::string_view journal_magic = "MBJRNL01";  ///< the last two: its version

enum class RecordKind : std::uint32_t {
    header = 1,   ///< JSON: JournalHeader
    writer = 2,   ///< JSON: JournalWriterInfo
    tile = 3,     ///< i32 x, y, width, height in the picture; its pixels, three numbers each
    lost = 4,     ///< i32 x, y, width, height: no longer valid
    refined = 5,  ///< u32 pass, u32 n; n i32 pixel indices into the film; n times three numbers
    finished = 6  ///< the whole picture, or all its shares, is here; no body
};

/// What picture a journal belongs to.
struct JournalHeader {
    std::uint64_t key = 0;      ///< equal keys mean bit-identical pictures: picture_key
    int width = 0, height = 0;  ///< of the whole picture, pixels
    Rect region;                ///< the part asked for
    Rect film;                  ///< the part rendered: the region and what refining it needs
    bool double_precision = false;
    bool refines = false;                     ///< adaptive: records of kind `refined` follow
    std::string shares;                       ///< as to_string(Shares)
    std::string scene, scene_hash, settings;  ///< as a picture's metadata have them
    /// With the above, all that is needed to render it again. The file as given to the first
    /// writer; may be empty.
    std::string scene_file, aa, filter;
    int max_bounces = 0;
    std::optional<double> light_scale;  ///< that override the scene's light
    std::optional<std::array<double, 3>> ambient_light;

    std::size_t pixel_bytes() const { return 3 * (double_precision ? 8 : 4); }
    bool operator==(const JournalHeader&) const = default;
};

/// Which process wrote the records that follow.
struct JournalWriterInfo {
    std::string host, device, version;
    int process = 0;
};

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
