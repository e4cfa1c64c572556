// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/stress/judge.h"

namespace rt {
namespace {

/// The JSON Schema of a result with this format, environment and fields.
template <typename T>
std::string schema_text(const std::string& format, const char* title, const Json& environment,
                        const T& sample) {
    Json keys = Json::array();
    for (const auto& [key, value] : environment.items()) keys.push_back(key);
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
    Json record = json_schema(sample);
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
    const Json environment = environment_json(), with_load = bench_environment_json(0);
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
}  // namespace rt
