// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <vector>

#include "host/base/error.h"
#include "host/journal/journal_format.h"
#include "host/render/film.h"

namespace rt {

/// A record checked against its journal: its rectangle lies in the picture's region, and its body
/// has the right length. Its span stays valid until the next record is read.
struct JournalRecord {
    RecordKind kind;
    Rect rect;                          ///< of tile and lost
    std::span<const std::byte> values;  ///< of tile: three numbers per pixel
    JournalWriterInfo writer;           ///< of writer
};

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
    Film<T> film{0, 0};
    std::vector<std::uint8_t> is_rendered;
    bool is_finished = false;
    std::vector<JournalWriterInfo> writers;

    /// The fraction of the film: 0 to 1.
    double share_rendered() const;
};

/// Reads the remaining records. Reuses the memory of `used`, a film no longer needed; if it has the
/// right size, pixels not rendered keep its values, else they are black. Throws Error
/// (ExitCode::limit) when memory is short.
template <typename T>
KnownPixels<T> read_known_pixels(JournalReader& reader, Film<T> used = {0, 0});

}  // namespace rt
