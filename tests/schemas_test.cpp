// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/stress/judge.h"

namespace rt::this_file {
namespace {

using namespace record;

/// A JSON Schema (draft 2020-12) of a record, from a sample of it.
class Schema {
   public:
    template <typename T>
    static Json schema_of(const T& x) {
        if constexpr (Record<const T>) {
            Schema schema;
            describe(schema, x);
            return std::move(schema).object();
        } else if constexpr (NamedEnum<T>) {
            Json names = Json::array();
            for (const auto& one : enum_names(x)) names.push_back(one.name);
            return {{"enum", names}};
        } else if constexpr (is_or_null<T>) {
            using Value = typename decltype(x.value)::value_type;
            return {{"anyOf", Json::array({schema_of(Value{}), {{"type", "null"}}})}};
        } else if constexpr (is_vector<T>) {
            return {{"type", "array"}, {"items", schema_of(typename T::value_type{})}};
        } else {
            return type_of(Writer::json_of(x));
        }
    }

    template <typename T>
    void operator()(const char* name, const T& x, const char* what) {
        if constexpr (is_optional<T>) {
            properties_[name] = schema_of(typename T::value_type{});
        } else {
            properties_[name] = schema_of(x);
            required_.push_back(name);
        }
        if (*what != '\0') properties_[name]["description"] = what;
    }

    template <typename Fields>
    void group(const char* name, const Fields& fields) {
        Schema inner;
        fields(inner);
        properties_[name] = std::move(inner).object();
        required_.push_back(name);
    }

   private:
    Json object() && {
        return {{"type", "object"},
                {"properties", std::move(properties_)},
                {"required", std::move(required_)},
                {"additionalProperties", false}};
    }

    static Json type_of(const Json& json) {
        if (json.is_null() || json.is_object()) return Json::object();  // anything
        if (json.is_array()) return {{"type", "array"}, {"items", type_of(json.at(0))}};
        if (json.is_number_integer()) return {{"type", "integer"}};
        return {{"type", json.type_name()}};
    }

    Json properties_ = Json::object(), required_ = Json::array();
};

/// The JSON Schema of a result with this format, environment and fields.
template <typename T>
std::string schema_text(const std::string& format, const char* title, const Json& environment,
                        const T& sample) {
    Json keys = Json::array();
    for (const auto& [key, value] : environment.items()) keys.push_back(key);
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
    Json record = Schema::schema_of(sample);
    Json properties{{"format", {{"const", format}}},
                    {"version", {{"const", 1}}},
                    {"environment",
                     {{"type", "object"},
                      {"required", keys},
                      {"description", "the machine and program; null for what is unknown"}}}};
    properties.update(record["properties"]);
    Json required{"format", "version", "environment"};
    required.insert(required.end(), record["required"].begin(), record["required"].end());
    record["properties"] = std::move(properties);
    record["required"] = std::move(required);
    schema.update(record);
    return json_text(schema);
}

/// The file in docs is what the records' fields say. MIRRORBALL_WRITE_SCHEMAS=1 writes it.
void expect_documented(const std::string& name, const std::string& text) {
    const std::string path = std::string(MIRRORBALL_SCENES_DIR) + "/../docs/" + name;
    if (std::getenv("MIRRORBALL_WRITE_SCHEMAS") != nullptr) std::ofstream(path) << text;
    std::ostringstream found;
    found << std::ifstream(path).rdbuf();
    EXPECT_EQ(found.str(), text) << name << " is out of date; set MIRRORBALL_WRITE_SCHEMAS=1";
}

TEST(Schemas, AreWhatTheRecordsSay) {
    const Json environment = environment_json();
    Json with_load = environment;
    with_load.update(machine_load_json(0));
    expect_documented("results.schema.json",
                      schema_text("mirrorball-render", "What render --stats=json prints",
                                  environment, RenderStats{}));
    expect_documented(
        "bench.schema.json",
        schema_text("mirrorball-bench", "What bench --json writes", with_load, BenchResult{}));
    expect_documented("converge.schema.json",
                      schema_text("mirrorball-converge", "What converge --json writes", with_load,
                                  ConvergeResult{}));
    expect_documented(
        "stress.schema.json",
        schema_text("mirrorball-stress", "What stress --json writes", with_load, StressResult{}));
}

}  // namespace
}  // namespace rt::this_file
