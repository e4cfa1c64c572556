// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/measure/bench.h"
#include "host/record/record.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

constexpr const char* remedy = "; write one with 'bench --json FILE'";
constexpr std::size_t max_baseline_bytes = std::size_t{1} << 28;

Baseline read_rows(const Json& json, const std::string& path) {
    if (json.at("format") != "mirrorball-bench" || json.at("version") != 1) {
        throw Error(ExitCode::input,
                    path + ": is not of format mirrorball-bench, version 1" + remedy);
    }
    Baseline baseline;
    for (const Json& row : json.at("rows")) {
        const Json& figures = row.at("figures");
        if (figures.is_null()) continue;
        BenchFigures& known = baseline[row.at("key").get<std::string>()];
        read_json(figures.at("trace"), known.trace);
        read_json(figures.at("total"), known.total);
    }
    return baseline;
}

}  // namespace

Baseline load_baseline(const std::string& path) {
    const FileText text = read_text_file(path, max_baseline_bytes);
    try {
        return read_rows(Json::parse(text.view()), path);
    } catch (const Json::exception&) {
        throw Error(ExitCode::input, path + ": is not a result of mirrorball bench" + remedy);
    }
}

bool is_slower(const Spread& before, const Spread& now, double max_regress) {
    return now.median > before.median * (1 + max_regress) &&
           now.median - before.median > 3 * (before.mad + now.mad);
}

void check_baseline(const std::vector<BenchCase>& rows, const Baseline& baseline) {
    const auto is_known = [&](const BenchCase& row) { return baseline.contains(key_of(row)); };
    if (std::ranges::any_of(rows, is_known)) return;
    throw Error(ExitCode::input,
                "no row matches the baseline; use the same scenes, sizes, AA modes and devices");
}

std::vector<std::string> regressions(const BenchResult& result, const Baseline& baseline,
                                     double max_regress) {
    std::vector<std::string> slower;
    for (const BenchRow& row : result.rows) {
        const std::string key = key_of(row.asked);
        const auto known = baseline.find(key);
        if (known == baseline.end() || !row.figures) continue;
        for (const auto& [what, figure] :
             {std::pair{"total", &BenchFigures::total}, std::pair{"trace", &BenchFigures::trace}}) {
            const Spread &before = known->second.*figure, &now = (*row.figures).*figure;
            if (!is_slower(before, now, max_regress)) continue;
            slower.push_back(
                fmt::format("{}: {} {:.6f} s +- {:.1f}% was {:.6f} s +- {:.1f}% ({:+.1f}%)", key,
                            what, now.median, now.noise_percent(), before.median,
                            before.noise_percent(), 100 * (now.median / before.median - 1)));
            break;
        }
    }
    return slower;
}

}  // namespace rt
