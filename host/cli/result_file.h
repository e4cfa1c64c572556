// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// Where results go besides the table: a file, "-" for stdout, or empty for nowhere.
struct ResultFiles {
    std::string json, csv;

    bool take_stdout() const { return json == "-" || csv == "-"; }
};

/// Rejects, before anything is measured, a path that write_result could not or should not write:
/// Error (output) for a place that cannot be written, Error (usage) for an existing file that does
/// not begin with `first_bytes` as results do: "--json scene.json" must not replace a scene.
/// Accepts "" and "-".
void check_result_path(const std::string& path, const std::string& first_bytes);

/// Writes results to stdout ("-"), atomically to a file, or nowhere (""). Throws Error (output).
void write_result(const std::string& path, const std::string& text);

}  // namespace rt
