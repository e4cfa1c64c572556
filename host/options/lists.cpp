// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "host/base/error.h"

namespace rt {

namespace {

/// Whether a word names a place for results: not an existing scene or picture.
bool may_take_results(const std::string& word) {
    if (word == "-") return true;
    if (word.starts_with("-")) return false;
    std::ifstream file(word, std::ios::binary);
    std::string start(32, ' ');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    return file.gcount() == 0 || word.ends_with(".csv") ||
           start.find("\"format\": \"mirrorball") != std::string::npos;
}

}  // namespace

std::vector<AaMode> parse_aa_list(const std::string& text) {
    std::vector<AaMode> modes;
    for (const AaMode& mode : list_of(parse_aa)(text)) {
        if (std::find(modes.begin(), modes.end(), mode) == modes.end()) modes.push_back(mode);
    }
    return modes;
}

void add_size(const CommandLine& verb, std::optional<PictureSize>& size) {
    verb.value("--size", "WxH|N", size, parse_size,
               "picture size in pixels (default: the scene's)");
}

void add_encoding(const CommandLine& verb, Encoding& encoding) {
    add_choice(verb, "--encoding", encoding, encoding_names,
               "how 8-bit files store linear light (default: display, value x 255)");
}

void add_device_list(const CommandLine& verb, const std::string& option,
                     std::vector<std::string>& devices) {
    verb.value(option, "LIST", devices, list_of(parse_device),
               "devices as for render --device, separated by commas (default: all, which is "
               "pthreads and every OpenCL device)");
}

void add_precisions(const CommandLine& verb, std::vector<Precision>& precisions) {
    static const Named<std::vector<Precision>> choices[] = {
        {"float", {Precision::float32}},
        {"double", {Precision::float64}},
        {"both", {Precision::float32, Precision::float64}}};
    add_choice(verb, "--precision", precisions, choices, "arithmetic precision (default: both)");
}

void add_repeats(const CommandLine& verb, int& repeats, int least) {
    verb.value(
        "--repeats", "N", repeats, count_in(least, 1000),
        fmt::format("number of timed rounds after the warm-up, at least {} (default: 5)", least));
}

void add_result_file(const CommandLine& verb, const std::string& option, std::string& file,
                     const std::string& help) {
    verb.optional_value(option, "FILE|-", help, "-", may_take_results,
                        [&file](const std::string& text) {
                            if (text.empty()) refuse(text, "expected a file name, or - for stdout");
                            file = text;
                        });
}

void add_result_files(const CommandLine& verb, ResultFiles& files) {
    add_result_file(verb, "--json", files.json, "write all measurements as JSON");
    add_result_file(verb, "--csv", files.csv, "write one row per run as CSV");
}

void check_result_files(const ResultFiles& files) {
    if (files.json == "-" && files.csv == "-") {
        usage_error("--json and --csv cannot both write to stdout; send one to a file");
    }
}

}  // namespace rt
