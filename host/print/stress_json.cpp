// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "host/base/text.h"
#include "host/picture/render_stats.h"
#include "host/print/print_run.h"
#include "host/print/print_stress.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

/// null for no limit
Json limit_json(std::size_t limit) {
    return limit == std::numeric_limits<std::size_t>::max() ? Json() : Json(limit);
}

/// null for what is not finite
Json number_json(double number) { return std::isfinite(number) ? Json(number) : Json(); }

Json tolerance_json(const StressTolerance& tolerance) {
    return {{"wrong", limit_json(tolerance.most_wrong)},
            {"wrong_at_edges", limit_json(tolerance.most_wrong_at_edges)},
            {"max_error", tolerance.max_error},
            {"may_overflow", tolerance.may_overflow},
            {"in_float", tolerance.in_float}};
}

const char* verdict_of(const StressRow& row) {
    if (!row.judged) return "not judged";
    return row.why.empty() ? "pass" : "fail";
}

Json row_json(const StressRow& row) {
    Json json{{"renderer", row.renderer},
              {"device", row.device},
              {"precision", precision_name(row.double_precision)},
              {"verdict", verdict_of(row)},
              {"why", row.why},
              {"seconds", row.seconds}};
    if (row.rays) {
        json["rays"] = {{"traced", row.rays->rays},
                        {"failures", row.rays->failures},
                        {"max_error", number_json(row.rays->max_error)}};
        return json;
    }
    if (row.refused + row.rendered > 0) {
        json["texts"] = {{"refused", row.refused}, {"rendered", row.rendered}};
    }
    json["picture"] = {{"wrong", row.figures.wrong},
                       {"wrong_at_edges", row.figures.wrong_at_edges},
                       {"max_error", number_json(row.figures.max_error)},
                       {"nan", row.figures.nans},
                       {"infinite", row.figures.infinities},
                       {"hash", hash_text(row.hash)}};
    return json;
}

Json case_json(const StressCaseResult& one) {
    Json rows = Json::array();
    for (const StressRow& row : one.rows) rows.push_back(row_json(row));
    return {{"label", one.label},
            {"value", one.value},
            {"passed", one.passed()},
            {"bar", tolerance_json(one.tolerance)},
            {"disagreement", one.disagreement},
            {"reference_seconds", one.reference_seconds},
            {"rows", rows}};
}

Json family_json(const StressFamilyResult& family) {
    Json cases = Json::array();
    for (const StressCaseResult& one : family.cases) cases.push_back(case_json(one));
    return {{"name", family.name},
            {"parameter", family.parameter},
            {"why", family.why},
            {"passed", family.passed()},
            {"cases", cases}};
}

}  // namespace

Json stress_json(const StressResult& result) {
    Json families = Json::array();
    for (const StressFamilyResult& family : result.families) {
        families.push_back(family_json(family));
    }
    return {{"format", "mirrorball-stress"},
            {"version", 1},
            {"environment", bench_environment_json(result.load_before)},
            {"quick", result.quick},
            {"interrupted", result.interrupted},
            {"passed", result.passed()},
            {"seconds", result.seconds},
            {"families", families}};
}

}  // namespace rt
