// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/measure/bench.h"
#include "host/measure/converge.h"
#include "host/print/print_stats.h"
#include "host/process/stop_signal.h"
#include "host/record/record.h"
#include "host/stress/judge.h"

// The results of bench, converge and stress as text, JSON and CSV.
namespace rt {

/// The first bytes of every result of this format.
std::string json_start(const std::string& format);

/// A result of bench, converge or stress: its format, version 1, environment, every raw run, and
/// the figures computed from them (docs/FORMAT.schema.json).
template <typename T>
std::string result_json(const std::string& format, const T& result) {
    Json environment = environment_json();
    environment.update(machine_load_json(result.load_before));
    Json json{{"format", "mirrorball-" + format}, {"version", 1}, {"environment", environment}};
    json.update(json_of(result));
    return json_text(json);
}

/// How many rounds the rows have: "4 rounds after a warm-up", or with an interrupt
/// "1 of 4 rounds after a warm-up, interrupted".
template <typename Row>
std::string rounds_text(const std::vector<Row>& rows, int asked, bool interrupted) {
    std::size_t done = 0;
    for (const Row& row : rows) done = std::max(done, row.repeats.size());
    const std::string rounds = counted(static_cast<std::size_t>(asked), "round");
    return interrupted ? fmt::format("{} of {} after a warm-up, interrupted", done, rounds)
                       : rounds + " after a warm-up";
}

/// Reports on stderr the rows that are wrong or failed; `name` gives what a row is called. Returns
/// the exit status of what measured them.
template <typename Row, typename Name>
int report_bad_rows(const std::vector<Row>& rows, bool interrupted, const Name& name) {
    bool wrong = false, failed = false, finite = true;
    for (const Row& row : rows) {
        if (row.verdict != Verdict::wrong && row.verdict != Verdict::failed) continue;
        (row.verdict == Verdict::wrong ? wrong : failed) = true;
        for (const auto* runs : {&row.warm_up, &row.repeats}) {
            for (const RenderStats& run : *runs) finite = finite && run.non_finite == 0;
        }
        print_note(fmt::format("{}: {}: {}", name(row.asked), to_string(row.verdict), row.why));
    }
    if (interrupted) return 128 + stop_flag();
    if (!finite) return static_cast<int>(ExitCode::non_finite);
    if (wrong) return static_cast<int>(ExitCode::different);
    return static_cast<int>(failed ? ExitCode::device : ExitCode::done);
}

/// Human-readable tables, at most 100 columns wide.
std::string bench_text(const BenchResult& result);
std::string converge_text(const ConvergeResult& result);

/// The verdict, then a line per family: its worst figures, and below a line for each case and
/// renderer that failed. Verbose: also why a family matters, and a line for every one.
std::string stress_text(const StressResult& result, bool verbose);

/// The names of the families and their cases; those of --quick are marked.
std::string stress_list(const std::vector<StressFamily>& families);

/// The first bytes of every CSV of bench and converge.
inline constexpr const char* csv_start = "scene,scene_hash,";

/// A header and a line per run, warm-up (round 0) and repeats.
std::string bench_csv(const BenchResult& result);
std::string converge_csv(const ConvergeResult& result);

}  // namespace rt
