// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/record/describe.h"

// What is made of a record's fields (describe.h): json_of, read_json, csv_row.
namespace rt {

using Json = nlohmann::ordered_json;

namespace record {

struct AnyArchive {
    void operator()(const char*, auto&&, const char*) {}
    void group(const char*, const auto&) {}
};

template <typename T>
concept Record = requires(AnyArchive a, T& x) {
    describe(a, x);
};
template <typename T>
concept NamedEnum = std::is_enum_v<T> && requires(T x) {
    enum_names(x);
};

template <typename T>
inline constexpr bool is_optional = false;
template <typename T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <typename T>
inline constexpr bool is_or_null = false;
template <typename T>
inline constexpr bool is_or_null<OrNull<T>> = true;
template <typename T>
inline constexpr bool is_vector = false;
template <typename T>
inline constexpr bool is_vector<std::vector<T>> = true;

/// Writes a record's fields in their order.
class Writer {
   public:
    template <typename T>
    static Json json_of(const T& x) {
        if constexpr (Record<const T>) {
            Writer writer;
            describe(writer, x);
            return std::move(writer.json_);
        } else if constexpr (NamedEnum<T>) {
            return name_of(enum_names(x), x);
        } else if constexpr (is_or_null<T>) {
            return x.value ? json_of(*x.value) : Json();
        } else if constexpr (is_vector<T>) {
            Json array = Json::array();
            for (const auto& item : x) array.push_back(json_of(item));
            return array;
        } else {
            return x;
        }
    }

    template <typename T>
    void operator()(const char* name, const T& x, const char*) {
        if constexpr (is_optional<T>) {
            if (x) json_[name] = json_of(*x);
        } else {
            json_[name] = json_of(x);
        }
    }

    template <typename Fields>
    void group(const char* name, const Fields& fields) {
        Writer inner;
        fields(inner);
        json_[name] = std::move(inner.json_);
    }

   private:
    Json json_ = Json::object();
};

/// Reads a record's fields; throws Error (ExitCode::input) that names the field which is missing or
/// wrong.
class Reader {
   public:
    Reader(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}

    template <typename T>
    static void read(const Json& json, T& x, const std::string& path) {
        if constexpr (Record<T>) {
            if (!json.is_object()) refuse(path, "no object");
            Reader reader(json, path + "/");
            describe(reader, x);
        } else if constexpr (NamedEnum<T>) {
            const auto value =
                value_of(enum_names(x), json.is_string() ? json.get<std::string>() : "");
            if (!value) refuse(path, "unknown");
            x = *value;
        } else if constexpr (is_vector<T>) {
            if (!json.is_array()) refuse(path, "no list");
            x.clear();
            for (const Json& item : json) {
                const std::string place = path + "/" + std::to_string(x.size());
                read(item, x.emplace_back(), place);
            }
        } else if constexpr (std::is_arithmetic_v<T>) {
            read_number(json, x, path);
        } else {
            try {
                json.get_to(x);
            } catch (const std::exception&) {  // of the library, or of a from_json
                refuse(path, "wrong type");
            }
        }
    }

    template <typename T>
    void operator()(const char* name, T&& x, const char*) {
        using Value = std::remove_reference_t<T>;
        if constexpr (std::is_lvalue_reference_v<T> && !std::is_const_v<Value>) {
            const auto at = json_.find(name);
            if constexpr (is_optional<Value>) {
                if (at != json_.end()) read(*at, x.emplace(), path_ + name);
            } else {
                if (at == json_.end()) refuse(path_ + name, "missing");
                read(*at, x, path_ + name);
            }
        }
    }

    template <typename Fields>
    void group(const char* name, const Fields& fields) {
        const auto at = json_.find(name);
        if (at == json_.end() || !at->is_object()) refuse(path_ + name, "missing");
        Reader inner(*at, path_ + name + "/");
        fields(inner);
    }

   private:
    [[noreturn]] static void refuse(const std::string& path, const char* what) {
        throw Error(ExitCode::input, path + ": " + what);
    }

    /// Integers that do not fit are refused: nlohmann's get() wraps them.
    template <typename T>
    static void read_number(const Json& json, T& x, const std::string& path) {
        if constexpr (std::same_as<T, bool>) {
            if (!json.is_boolean()) refuse(path, "wrong type");
            x = json.get<bool>();
        } else if constexpr (std::integral<T>) {
            const bool fits =
                json.is_number_unsigned()
                    ? std::in_range<T>(json.get<std::uint64_t>())
                    : json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
            if (!fits) refuse(path, "no whole number in range");
            x = json.get<T>();
        } else {
            if (!json.is_number()) refuse(path, "no number");
            x = json.get<T>();
        }
    }

    const Json& json_;
    const std::string path_;
};

/// The cells of a row, or the names of its columns: fields that are neither records nor lists.
class Row {
   public:
    std::vector<std::string> names, cells;

    template <typename T>
    void operator()(const char* name, const T& x, const char*) {
        names.emplace_back(name);
        cells.push_back(cell_of(x));
    }

    template <typename Fields>
    void group(const char*, const Fields& fields) {
        fields(*this);
    }

   private:
    template <typename T>
    static std::string cell_of(const T& x) {
        if constexpr (is_optional<T>) {
            return x ? cell_of(*x) : "";
        } else if constexpr (std::is_floating_point_v<T>) {
            return fmt::format("{}", x);
        } else {
            const Json json = Writer::json_of(x);
            return json.is_string() ? csv_quoted(json.get<std::string>()) : json.dump();
        }
    }
};

}  // namespace record

/// As JSON, fields in their order.
template <typename T>
Json json_of(const T& x) {
    return record::Writer::json_of(x);
}

/// A JSON value as indented text with a newline; invalid UTF-8 (a file name may hold it) becomes
/// replacement characters.
inline std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Throws Error (ExitCode::input) naming the field that is missing or wrong.
template <typename T>
void read_json(const Json& json, T& x) {
    record::Reader::read(json, x, "");
}

/// The names of its fields and their cells; neither lists nor lists of records.
template <typename T>
record::Row csv_row(const T& x) {
    record::Row row;
    describe(row, x);
    return row;
}

}  // namespace rt
