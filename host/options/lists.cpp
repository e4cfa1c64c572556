// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "host/opencl/device_spec.h"

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

std::vector<std::string> split_list(const std::string& option, const std::string& text) {
    std::vector<std::string> parts;
    std::size_t at = 0;
    for (;;) {
        const std::size_t comma = text.find(',', at);
        parts.push_back(text.substr(at, comma - at));
        if (parts.back().empty()) refuse(option, text, "give a list separated by commas");
        if (comma == std::string::npos) return parts;
        at = comma + 1;
    }
}

std::vector<AaMode> parse_aa_list(const std::string& option, const std::string& text) {
    std::vector<AaMode> modes;
    for (const std::string& part : split_list(option, text)) {
        const auto mode = parse_aa_mode(part);
        if (!mode) refuse(option, part, "not an AA mode; see --aa in 'mirrorball render --help'");
        if (std::find(modes.begin(), modes.end(), *mode) == modes.end()) modes.push_back(*mode);
    }
    return modes;
}

int parse_count(const std::string& option, const std::string& text, int least, int most) {
    const auto numbers = parse_integers(text, ',');
    if (!numbers || numbers->size() != 1 || numbers->front() < least || numbers->front() > most) {
        refuse(option, text, fmt::format("give {} to {}", least, most));
    }
    return numbers->front();
}

void add_device_list(const CommandLine& verb, std::vector<std::string>& devices) {
    verb.option("--devices", "LIST",
                "device specs as for render --device, separated by commas; threads; all (default): "
                "threads and every OpenCL device",
                [&](const std::string& text) {
                    devices = split_list("--devices", text);
                    for (const std::string& spec : devices) {
                        check_device_list(spec);
                    }
                });
}

void add_precisions(const CommandLine& verb, std::vector<Precision>& precisions) {
    add_choice<std::vector<Precision>>(verb, "--precision", precisions,
                                       {{"float", {Precision::float32}},
                                        {"double", {Precision::float64}},
                                        {"both", {Precision::float32, Precision::float64}}},
                                       "arithmetic (default both)");
}

void add_count(const CommandLine& verb, const std::string& option, int& count, int least, int most,
               const std::string& help) {
    verb.option(option, "N", help, [&count, option, least, most](const std::string& text) {
        count = parse_count(option, text, least, most);
    });
}

void add_result_file(const CommandLine& verb, const std::string& option, std::string& file,
                     const std::string& help) {
    verb.optional_value(option, "FILE|-", help, "-", may_take_results,
                        [&file, option](const std::string& text) {
                            if (text.empty()) refuse(option, text, "name a file, or - for stdout");
                            file = text;
                        });
}

void add_result_files(const CommandLine& verb, ResultFiles& files) {
    add_result_file(verb, "--json", files.json, "all raw values and figures as JSON");
    add_result_file(verb, "--csv", files.csv, "a row per run as CSV");
}

void check_result_files(const ResultFiles& files) {
    if (files.json == "-" && files.csv == "-") {
        refuse("--csv", "-", "stdout takes JSON or CSV; send one to a file");
    }
}

}  // namespace rt
