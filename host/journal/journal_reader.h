// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/journal/journal_format.h"
#include "host/render/film.h"
#include "host/render/picture_loop.h"

namespace rt {

/// A record that fits its journal: its rectangle or pixels lie in the film, and its body is as long
/// as they say. What it points to is there until the next one is read.
struct JournalRecord {
    RecordKind kind;
    Rect rect;                           ///< of tile and lost
    int pass = 0;                        ///< of refined
    std::span<const std::byte> indices;  ///< of refined: i32 each
    std::span<const std::byte> values;   ///< of tile and refined: three numbers a pixel
    JournalWriterInfo writer;            ///< of writer
};

/// Reads a journal record by record, whatever its bytes.
class JournalReader {
   public:
    /// Reads the header. Throws Error (ExitCode::input), without a file's name, when there is none
    /// that this version can read. `size`: bytes of the stream.
    JournalReader(std::istream& stream, std::uint64_t size);

    const JournalHeader& header() const { return header_; }

    /// The next record; empty at the end and before the first bad one.
    std::optional<JournalRecord> next();

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

/// Pixels that were refined in one pass: indices into the film, and three numbers each.
template <typename T>
struct RefinedPixels {
    std::vector<std::int32_t> pixels;
    std::vector<T> colors;
};

/// What a journal holds of a picture, all together.
template <typename T>
struct KnownPixels {
    Film<T> film{0, 0};  ///< after the first pass; black where is_rendered is 0
    std::vector<std::uint8_t> is_rendered;
    RefinedPixels<T> refined[refine_passes];
    bool is_finished = false;
    std::vector<JournalWriterInfo> writers;

    /// Of the film, how much was rendered in the first pass: 0 to 1.
    double share_rendered() const;

    /// The film with what was refined; takes it from here.
    Film<T> take_refined_film();
};

/// Reads the rest. A film that is no longer needed may be given for its memory; where it has the
/// right size, pixels that are not rendered keep what it had. Throws Error (ExitCode::limit) when
/// memory is short.
template <typename T>
KnownPixels<T> read_known_pixels(JournalReader& reader, Film<T> used = {0, 0});

}  // namespace rt
