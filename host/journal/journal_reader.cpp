// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_reader.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "host/base/memory.h"

namespace rt {

namespace {

constexpr std::size_t head_bytes = 12;            // of a record
constexpr std::size_t most_text_bytes = 1 << 16;  // of a header or writer

template <typename N>
N number_at(std::span<const std::byte> bytes, std::size_t at) {
    N number;
    std::memcpy(&number, bytes.data() + at, sizeof(N));
    return number;
}

Rect rect_at_start(std::span<const std::byte> body) {
    return {number_at<std::int32_t>(body, 0), number_at<std::int32_t>(body, 4),
            number_at<std::int32_t>(body, 8), number_at<std::int32_t>(body, 12)};
}

}  // namespace

JournalReader::JournalReader(std::istream& stream, std::uint64_t size)
    : stream_(stream), size_(size) {
    char magic[journal_magic.size()];
    stream_.read(magic, sizeof(magic));
    const std::string_view found(magic, static_cast<std::size_t>(stream_.gcount()));
    if (found.size() < sizeof(magic) && journal_magic.starts_with(found)) {
        throw DamagedJournal(ExitCode::input, "is empty; render it again");
    }
    if (!found.starts_with(journal_magic.substr(0, 6))) {
        throw Error(ExitCode::input, "is not a journal; use a file written by render --shard");
    }
    if (found != journal_magic) {
        throw Error(ExitCode::input,
                    "was written by a different version of mirrorball; render it again");
    }
    good_bytes_ = sizeof(magic);
    if (!read_record() || kind_ != RecordKind::header) {
        throw DamagedJournal(ExitCode::input, "its header is damaged; render it again");
    }
    header_ = parse_header(body_);
}

/// Reads the next record; false if it is truncated or damaged.
bool JournalReader::read_record() {
    if (size_ - good_bytes_ < head_bytes) return false;
    std::byte head[head_bytes];
    if (!stream_.read(reinterpret_cast<char*>(head), sizeof(head))) return false;
    kind_ = static_cast<RecordKind>(number_at<std::uint32_t>(head, 0));
    const std::size_t length = number_at<std::uint32_t>(head, 4);
    if (length > size_ - good_bytes_ - head_bytes) return false;
    body_.resize(length);
    if (!stream_.read(reinterpret_cast<char*>(body_.data()), static_cast<std::streamsize>(length)))
        return false;
    if (record_crc(kind_, body_) != number_at<std::uint32_t>(head, 8)) return false;
    if (kind_ == RecordKind::header && length > most_text_bytes) return false;
    good_bytes_ += head_bytes + length;
    return true;
}

bool JournalReader::interpret(JournalRecord& record) const {
    const std::span<const std::byte> body(body_);
    record.kind = kind_;
    const std::size_t pixel = header_.pixel_bytes();
    switch (kind_) {
        case RecordKind::header:
            return false;
        case RecordKind::writer:
            if (body.size() > most_text_bytes) return false;
            record.writer = parse_writer(body);
            return true;
        case RecordKind::tile:
            if (body.size() < 16) return false;
            record.rect = rect_at_start(body);
            record.values = body.subspan(16);
            return is_within(record.rect, header_.picture.region) &&
                   record.values.size() == static_cast<std::size_t>(record.rect.pixels()) * pixel;
        case RecordKind::lost:
            if (body.size() != 16) return false;
            record.rect = rect_at_start(body);
            return is_within(record.rect, header_.picture.region);
        case RecordKind::finished:
            return body.empty();
    }
    return false;
}

std::optional<JournalRecord> JournalReader::next() {
    const std::uint64_t before = good_bytes_;
    JournalRecord record{};
    if (read_record() && interpret(record)) return record;
    good_bytes_ = before;
    stream_.setstate(std::ios::failbit);
    return std::nullopt;
}

template <typename T>
double KnownPixels<T>::share_rendered() const {
    if (is_rendered.empty()) return 0;
    const auto count = std::count(is_rendered.begin(), is_rendered.end(), std::uint8_t{1});
    return static_cast<double>(count) / static_cast<double>(is_rendered.size());
}

template <typename T>
KnownPixels<T> read_known_pixels(JournalReader& reader, Film<T> used) {
    const Rect film = reader.header().picture.region;
    KnownPixels<T> known;
    if (used.width == film.width && used.height == film.height) {
        known.film = std::move(used);
    } else {
        check_memory(static_cast<std::uint64_t>(film.pixels()) * (3 * sizeof(T) + 1),
                     "the film of a journal", "render parts with --crop");
        known.film = Film<T>(film.width, film.height);
    }
    known.is_rendered.resize(static_cast<std::size_t>(film.pixels()));
    while (const auto record = reader.next()) {
        const Rect& rect = record->rect;
        for (int row = 0; row < rect.height; ++row) {
            const std::size_t at = index_in(film, rect.x, rect.y + row);
            const bool is_there = record->kind == RecordKind::tile;
            const std::size_t bytes = 3 * sizeof(T) * static_cast<std::size_t>(rect.width);
            if (is_there) {
                std::memcpy(&known.film.rgb[3 * at],
                            record->values.data() + static_cast<std::size_t>(row) * bytes, bytes);
            } else {
                std::memset(&known.film.rgb[3 * at], 0, bytes);
            }
            std::fill_n(known.is_rendered.begin() + static_cast<std::ptrdiff_t>(at), rect.width,
                        std::uint8_t{is_there});
        }
        if (record->kind == RecordKind::writer) known.writers.push_back(record->writer);
        if (record->kind == RecordKind::finished) known.is_finished = true;
    }
    return known;
}

template struct KnownPixels<float>;
template struct KnownPixels<double>;
template KnownPixels<float> read_known_pixels(JournalReader&, Film<float>);
template KnownPixels<double> read_known_pixels(JournalReader&, Film<double>);

}  // namespace rt
