// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "host/measure/bench_result.h"
#include "host/measure/statistics.h"
#include "host/picture/render_stats.h"

namespace rt {

/// The first bytes of every result of this format.
std::string json_start(const std::string& format);

/// A run of a benchmark: settings, device, seconds, rays, rays per second, image and error, as in
/// stats_json.
nlohmann::ordered_json run_json(const RenderStats& run);

nlohmann::ordered_json runs_json(std::span<const RenderStats> runs);

/// Adds verdict, why, `figures`, warm-up and repeats.
void add_runs(nlohmann::ordered_json& json, const TimedRuns& runs, nlohmann::ordered_json figures);

/// {"path", "name", "hash"}
nlohmann::ordered_json scene_json(const std::string& path, const std::string& name,
                                  std::uint64_t hash);

/// {"median", "mad", "min", "max"}
nlohmann::ordered_json spread_json(const Spread& spread);

/// environment_json plus the load before the measurements and whether it makes the machine busy;
/// "load" itself is from after them.
nlohmann::ordered_json bench_environment_json(double load_before);

/// The first line of the CSV of bench and converge, without its newline.
std::string run_csv_header();

/// A line for each run, warm-up (round 0) and repeats; text with a comma or a quote in it is quoted
/// (RFC 4180). `device`: spec.
std::string runs_csv(const TimedRuns& runs, const std::string& device);

}  // namespace rt
