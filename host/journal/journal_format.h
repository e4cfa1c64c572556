// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/error.h"
#include "host/render/film.h"
#include "host/render/picture_spec.h"

// A journal (.mbj) stores the tiles of a picture as they are finished, so that an interrupted
// render can resume, and several machines can render shares of one picture.
//
// The file is 8 bytes of magic and then records, little-endian:
//     u32 kind, u32 bytes of the body, u32 CRC-32 of kind, bytes and body; body
// The header comes first, once. Later records override earlier ones. Nothing after the first bad
// record is read.
namespace rt {

inline constexpr std::string_view journal_magic = "MBJRNL04";  ///< the last two: its version

enum class RecordKind : std::uint32_t {
    header = 1,   ///< JSON: JournalHeader
    tile = 3,     ///< i32 x, y, width, height in the picture; its pixels, three numbers each
    finished = 5  ///< the whole picture, or all its shares, is here; no body
};

/// What picture a journal belongs to, and who began it.
struct JournalHeader {
    std::uint64_t key = 0;  ///< of all that the bits of a picture depend on, except its devices
    PictureSpec picture;
    std::string shares;             ///< as to_string(Shares)
    std::string scene, scene_hash;  ///< as a picture's metadata have them
    std::string inexact_devices;    ///< those that may round differently, a line each
    std::string writer;             ///< "threads on HOST", for messages

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
    a("inexact_devices", x.inexact_devices, "");
    a("writer", x.writer, "");
}

/// A record's CRC-32 (as in zlib).
std::uint32_t record_crc(RecordKind kind, std::span<const std::byte> body);

/// Appends a record to `bytes`.
void append_record(std::vector<std::byte>& bytes, RecordKind kind, std::span<const std::byte> body);

/// The bytes that a journal begins with: the magic and the header's record.
std::vector<std::byte> journal_start(const JournalHeader& header);

/// A record checked against its journal: its rectangle lies in the picture's region, and its body
/// has the right length. Its span stays valid until the next record is read.
struct JournalRecord {
    RecordKind kind;
    Rect rect;                          ///< of tile
    std::span<const std::byte> values;  ///< of tile: three numbers per pixel
};

/// Calls visit(index of its first pixel in the film, its values) with each row of a tile; of other
/// records, with none.
template <typename Visit>
void for_each_row(const JournalRecord& record, const Rect& film, const Visit& visit) {
    const Rect& rect = record.rect;
    for (int row = 0; row < rect.height; ++row) {
        const std::size_t bytes = record.values.size() / static_cast<std::size_t>(rect.height);
        visit(index_in(film, rect.x, rect.y + row),
              record.values.subspan(static_cast<std::size_t>(row) * bytes, bytes));
    }
}

/// A journal whose header is missing or incomplete.
struct DamagedJournal : Error {
    using Error::Error;
};

/// Reads a journal record by record; safe for arbitrary bytes.
class JournalReader {
   public:
    /// Reads the header. Throws Error (ExitCode::input), without a file name, when this version
    /// cannot read it; DamagedJournal for one that was cut off or damaged. `size`: bytes of the
    /// stream.
    JournalReader(std::istream& stream, std::uint64_t size);

    const JournalHeader& header() const { return header_; }

    /// The next record; empty at the end or at the first bad record.
    std::optional<JournalRecord> next();

    std::uint64_t bytes() const { return size_; }

    /// Bytes up to the end of the last good record.
    std::uint64_t good_bytes() const { return good_bytes_; }

   private:
    bool read_record();
    bool interpret(JournalRecord& record) const;

    std::istream& stream_;
    const std::uint64_t size_;
    std::uint64_t good_bytes_ = 0;
    RecordKind kind_{};
    std::vector<std::byte> body_;
    JournalHeader header_;
};

/// Everything that a journal has of a picture.
template <typename T>
struct KnownPixels {
    Rect region;  ///< of the film in the picture
    Film<T> film{0, 0};
    std::vector<std::uint8_t> is_rendered;
    bool is_finished = false;

    /// The fraction of the film: 0 to 1.
    double share_rendered() const;

    /// Whether it has all of a tile of the picture.
    bool has(const Rect& tile) const;
};

/// Reads the remaining records. Throws Error (ExitCode::limit) when memory is short.
template <typename T>
KnownPixels<T> read_known_pixels(JournalReader& reader);

}  // namespace rt
