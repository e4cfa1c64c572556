// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/options/bench_options.h"
#include "host/options/parse.h"

namespace rt {

inline constexpr int most_bounces = 100000;
inline constexpr int most_threads = 4096;

/// Comma-separated AA modes, without duplicates.
std::vector<AaMode> parse_aa_list(const std::string& text);

// Options that several verbs share.
void add_size(const CommandLine& verb, std::optional<PictureSize>& size);
void add_encoding(const CommandLine& verb, Encoding& encoding);
void add_device_list(const CommandLine& verb, const std::string& option,
                     std::vector<std::string>& devices);
void add_precisions(const CommandLine& verb, std::vector<Precision>& precisions);
void add_repeats(const CommandLine& verb, int& repeats, int least);

/// --json or --csv: alone, the results go to stdout ("-"). The next word is the file unless that
/// exists and is not a result file: a scene or a picture.
void add_result_file(const CommandLine& verb, const std::string& option, std::string& file,
                     const std::string& help);
void add_result_files(const CommandLine& verb, ResultFiles& files);

/// Throws Error (ExitCode::usage) when both would go to stdout.
void check_result_files(const ResultFiles& files);

inline constexpr const char* bounces_help =
    "maximum number of mirror and refracted rays after the eye ray (default: the scene's)";
inline constexpr const char* quiet_help = "print no progress to stderr";
inline constexpr const char* scene_help = "scene file (.json, .nff, .obj, .ply)";
inline constexpr const char* json_help = "print JSON to stdout";

}  // namespace rt
