// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_format.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/base/error.h"

static_assert(std::endian::native == std::endian::little, "journals are little-endian");

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

constexpr int largest_side = 65536;

[[noreturn]] void refuse_header(const std::string& what) {
    throw Error(ExitCode::input, "its header is damaged (" + what + "); render it again");
}

const Json& member(const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found == json.end()) refuse_header(std::string("no ") + name);
    return *found;
}

int int_of(const Json& json, const char* name, int least, int most) {
    const Json& value = member(json, name);
    if (!value.is_number_integer()) refuse_header(name);
    const auto number = value.get<double>();  // exact where it is in range
    if (!(number >= least && number <= most)) refuse_header(name);
    return static_cast<int>(number);
}

bool bool_of(const Json& json, const char* name) {
    const Json& value = member(json, name);
    if (!value.is_boolean()) refuse_header(name);
    return value.get<bool>();
}

double number_of(const Json& value) {
    if (!value.is_number()) refuse_header("a number");
    return value.get<double>();
}

std::string text_of(const Json& json, const char* name) {
    const Json& value = member(json, name);
    if (!value.is_string()) refuse_header(name);
    return value.get<std::string>();
}

Json json_of(const Rect& rect) {
    return {{"x", rect.x}, {"y", rect.y}, {"width", rect.width}, {"height", rect.height}};
}

Rect rect_of(const Json& json, const char* name, const Rect& whole) {
    const Json& value = member(json, name);
    if (!value.is_object()) refuse_header(name);
    Rect rect;
    rect.x = int_of(value, "x", whole.x, whole.x + whole.width - 1);
    rect.y = int_of(value, "y", whole.y, whole.y + whole.height - 1);
    rect.width = int_of(value, "width", 1, whole.x + whole.width - rect.x);
    rect.height = int_of(value, "height", 1, whole.y + whole.height - rect.y);
    return rect;
}

std::string_view text_in(std::span<const std::byte> body) {
    return {reinterpret_cast<const char*>(body.data()), body.size()};
}

void append_json(std::vector<std::byte>& bytes, RecordKind kind, const Json& json) {
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
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
    Json json = {{"key", fmt::format("{:016x}", header.key)},
                 {"width", header.width},
                 {"height", header.height},
                 {"region", json_of(header.region)},
                 {"film", json_of(header.film)},
                 {"double", header.double_precision},
                 {"refines", header.refines},
                 {"shares", header.shares},
                 {"scene", header.scene},
                 {"scene_hash", header.scene_hash},
                 {"settings", header.settings},
                 {"scene_file", header.scene_file},
                 {"aa", header.aa},
                 {"filter", header.filter},
                 {"max_bounces", header.max_bounces}};
    if (header.light_scale) json["light_scale"] = *header.light_scale;
    if (header.ambient_light) json["ambient_light"] = *header.ambient_light;
    append_json(bytes, RecordKind::header, json);
}

void append_writer(std::vector<std::byte>& bytes, const JournalWriterInfo& writer) {
    append_json(bytes, RecordKind::writer,
                {{"host", writer.host},
                 {"device", writer.device},
                 {"version", writer.version},
                 {"process", writer.process}});
}

JournalHeader parse_header(std::span<const std::byte> body) {
    const Json json = Json::parse(text_in(body), nullptr, false);
    if (!json.is_object()) refuse_header("no JSON object");
    JournalHeader header;
    const std::string key = text_of(json, "key");
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), header.key, 16);
    if (error != std::errc() || end != key.data() + key.size()) refuse_header("key");
    header.width = int_of(json, "width", 1, largest_side);
    header.height = int_of(json, "height", 1, largest_side);
    const Rect whole{0, 0, header.width, header.height};
    header.film = rect_of(json, "film", whole);
    header.region = rect_of(json, "region", header.film);
    header.double_precision = bool_of(json, "double");
    header.refines = bool_of(json, "refines");
    header.shares = text_of(json, "shares");
    header.scene = text_of(json, "scene");
    header.scene_hash = text_of(json, "scene_hash");
    header.settings = text_of(json, "settings");
    if (!json.contains("scene_file")) return header;  // only merge --verify needs the rest
    header.scene_file = text_of(json, "scene_file");
    header.aa = text_of(json, "aa");
    header.filter = text_of(json, "filter");
    header.max_bounces = int_of(json, "max_bounces", 0, std::numeric_limits<int>::max());
    if (json.contains("light_scale")) header.light_scale = number_of(json["light_scale"]);
    if (json.contains("ambient_light")) {
        const Json& light = json["ambient_light"];
        if (!light.is_array() || light.size() != 3) refuse_header("ambient_light");
        header.ambient_light = {number_of(light[0]), number_of(light[1]), number_of(light[2])};
    }
    return header;
}

JournalWriterInfo parse_writer(std::span<const std::byte> body) {
    const Json json = Json::parse(text_in(body), nullptr, false);
    if (!json.is_object()) return {};
    try {
        return {text_of(json, "host"), text_of(json, "device"), text_of(json, "version"),
                int_of(json, "process", 0, std::numeric_limits<int>::max())};
    } catch (const Error&) {
        return {};
    }
}

}  // namespace rt
