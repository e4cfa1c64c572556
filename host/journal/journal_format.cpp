// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_format.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "host/base/memory.h"
#include "host/record/record.h"
#include "host/scene/scene.h"

static_assert(std::endian::native == std::endian::little, "journals are little-endian");

namespace rt {

namespace {

/// Precedes a record's body.
struct RecordHead {
    RecordKind kind;
    std::uint32_t bytes, crc;
};
static_assert(sizeof(RecordHead) == 12 && sizeof(Rect) == 16, "they are stored as they are");

constexpr std::size_t most_header_bytes = 1 << 16;

void append(std::vector<std::byte>& bytes, std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

/// Throws Error (ExitCode::input) describing the problem, without a file name.
JournalHeader parse_header(std::span<const std::byte> body) {
    const std::string_view text(reinterpret_cast<const char*>(body.data()), body.size());
    JournalHeader header;
    std::string what;
    try {
        read_json(Json::parse(text, nullptr, false), header);
        const PictureSpec& picture = header.picture;
        const int side = std::max(picture.width, picture.height);
        const Rect whole{0, 0, picture.width, picture.height};
        if (side > max_image_side || !is_within(picture.region, whole)) {
            what = "region";
        } else if (picture.max_bounces < 0) {
            what = "max_bounces";
        }
    } catch (const Error& error) {
        what = error.what();
    }
    if (what.empty()) return header;
    throw Error(ExitCode::input, "its header is damaged (" + what + "); render it again");
}

}  // namespace

std::uint32_t record_crc(RecordKind kind, std::span<const std::byte> body) {
    const std::uint32_t head[2] = {static_cast<std::uint32_t>(kind),
                                   static_cast<std::uint32_t>(body.size())};
    const uLong start = crc32_z(0, reinterpret_cast<const Bytef*>(head), sizeof(head));
    if (body.empty()) return static_cast<std::uint32_t>(start);  // null would reset zlib's CRC
    return static_cast<std::uint32_t>(
        crc32_z(start, reinterpret_cast<const Bytef*>(body.data()), body.size()));
}

void append_record(std::vector<std::byte>& bytes, RecordKind kind,
                   std::span<const std::byte> body) {
    const RecordHead head{kind, static_cast<std::uint32_t>(body.size()), record_crc(kind, body)};
    append(bytes, std::as_bytes(std::span(&head, 1)));
    append(bytes, body);
}

std::vector<std::byte> journal_start(const JournalHeader& header) {
    std::vector<std::byte> bytes;
    append(bytes, std::as_bytes(std::span(journal_magic)));
    const std::string text = json_of(header).dump(-1, ' ', false, Json::error_handler_t::replace);
    append_record(bytes, RecordKind::header, std::as_bytes(std::span(text)));
    return bytes;
}

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
    RecordHead head;
    if (size_ - good_bytes_ < sizeof(head)) return false;
    if (!stream_.read(reinterpret_cast<char*>(&head), sizeof(head))) return false;
    if (head.bytes > size_ - good_bytes_ - sizeof(head)) return false;
    kind_ = head.kind;
    body_.resize(head.bytes);
    if (!stream_.read(reinterpret_cast<char*>(body_.data()), head.bytes)) return false;
    if (record_crc(kind_, body_) != head.crc) return false;
    if (kind_ == RecordKind::header && head.bytes > most_header_bytes) return false;
    good_bytes_ += sizeof(head) + head.bytes;
    return true;
}

bool JournalReader::interpret(JournalRecord& record) const {
    const std::span<const std::byte> body(body_);
    record.kind = kind_;
    if (kind_ == RecordKind::finished) return body.empty();
    if (kind_ != RecordKind::tile || body.size() < sizeof(Rect)) return false;
    std::memcpy(&record.rect, body.data(), sizeof(Rect));
    record.values = body.subspan(sizeof(Rect));
    if (!is_within(record.rect, header_.picture.region)) return false;
    const auto pixels = static_cast<std::size_t>(record.rect.pixels());
    return record.values.size() == pixels * header_.pixel_bytes();
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
bool KnownPixels<T>::has(const Rect& tile) const {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
        const std::span row(&is_rendered[index_in(region, tile.x, y)],
                            static_cast<std::size_t>(tile.width));
        if (std::ranges::count(row, 0) > 0) return false;
    }
    return true;
}

template <typename T>
KnownPixels<T> read_known_pixels(JournalReader& reader) {
    const Rect film = reader.header().picture.region;
    check_memory(static_cast<std::uint64_t>(film.pixels()) * (3 * sizeof(T) + 1),
                 "the film of a journal", "render parts with --crop");
    KnownPixels<T> known;
    known.region = film;
    known.film = Film<T>(film.width, film.height);
    known.is_rendered.resize(static_cast<std::size_t>(film.pixels()));
    while (const auto record = reader.next()) {
        for_each_row(*record, film, [&](std::size_t at, std::span<const std::byte> row) {
            std::memcpy(&known.film.rgb[3 * at], row.data(), row.size());
            std::fill_n(known.is_rendered.begin() + static_cast<std::ptrdiff_t>(at),
                        record->rect.width, std::uint8_t{1});
        });
        if (record->kind == RecordKind::finished) known.is_finished = true;
    }
    return known;
}

template struct KnownPixels<float>;
template struct KnownPixels<double>;
template KnownPixels<float> read_known_pixels(JournalReader&);
template KnownPixels<double> read_known_pixels(JournalReader&);

}  // namespace rt
