// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_format.h"

#include <zlib.h>

#include <algorithm>
#include <bit>

#include "host/base/error.h"
#include "host/record/record.h"

static_assert(std::endian::native == std::endian::little, "journals are little-endian");

namespace rt {

namespace {

constexpr int largest_side = 65536;

std::string_view text_in(std::span<const std::byte> body) {
    return {reinterpret_cast<const char*>(body.data()), body.size()};
}

template <typename T>
void append_json(std::vector<std::byte>& bytes, RecordKind kind, const T& x) {
    const std::string text = json_of(x).dump(-1, ' ', false, Json::error_handler_t::replace);
    append_record(bytes, kind, std::as_bytes(std::span(text)));
}

template <typename N>
void append_number(std::vector<std::byte>& bytes, N number) {
    const auto raw = std::as_bytes(std::span(&number, 1));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
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
    append_number(bytes, static_cast<std::uint32_t>(kind));
    append_number(bytes, static_cast<std::uint32_t>(body.size()));
    append_number(bytes, record_crc(kind, body));
    bytes.insert(bytes.end(), body.begin(), body.end());
}

void append_header(std::vector<std::byte>& bytes, const JournalHeader& header) {
    append_json(bytes, RecordKind::header, header);
}

void append_writer(std::vector<std::byte>& bytes, const JournalWriterInfo& writer) {
    append_json(bytes, RecordKind::writer, writer);
}

JournalHeader parse_header(std::span<const std::byte> body) {
    JournalHeader header;
    std::string what;
    try {
        read_json(Json::parse(text_in(body), nullptr, false), header);
        const PictureSpec& picture = header.picture;
        const int side = std::max(picture.width, picture.height);
        const Rect whole{0, 0, picture.width, picture.height};
        if (side > largest_side || !is_within(picture.region, whole)) {
            what = "region";
        } else if (picture.max_bounces < 0) {
            what = "max_bounces";
        } else if (header.ambient_light && header.ambient_light->size() != 3) {
            what = "ambient_light";
        }
    } catch (const Error& error) {
        what = error.what();
    }
    if (what.empty()) return header;
    throw Error(ExitCode::input, "its header is damaged (" + what + "); render it again");
}

JournalWriterInfo parse_writer(std::span<const std::byte> body) {
    JournalWriterInfo writer;
    try {
        read_json(Json::parse(text_in(body), nullptr, false), writer);
    } catch (const Error&) {
    }
    return writer;
}

}  // namespace rt
