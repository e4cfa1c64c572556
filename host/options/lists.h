// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/options/bench_options.h"
#include "host/options/parse.h"

namespace rt {

/// The parts between commas. Throws Error (ExitCode::usage) for an empty part.
std::vector<std::string> split_list(const std::string& option, const std::string& text);

/// Comma-separated AA modes, without duplicates. Throws Error (ExitCode::usage).
std::vector<AaMode> parse_aa_list(const std::string& option, const std::string& text);

/// A whole number in a range. Throws Error (ExitCode::usage).
int parse_count(const std::string& option, const std::string& text, int least, int most);

// Options that bench and converge share.
void add_device_list(const CommandLine& verb, std::vector<std::string>& devices);
void add_precisions(const CommandLine& verb, std::vector<Precision>& precisions);
void add_count(const CommandLine& verb, const std::string& option, int& count, int least, int most,
               const std::string& help);

/// --json or --csv: alone, the results go to stdout ("-"). The next word is the file unless that
/// exists and is not a result file: a scene or a picture.
void add_result_file(const CommandLine& verb, const std::string& option, std::string& file,
                     const std::string& help);
void add_result_files(const CommandLine& verb, ResultFiles& files);

/// Throws Error (ExitCode::usage) when both would go to stdout.
void check_result_files(const ResultFiles& files);

}  // namespace rt
