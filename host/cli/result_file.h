// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

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

/// Writes the text, unless it is empty, to stdout ("-") or atomically to a file; for "" it does not
/// ask for it. Throws Error (output).
void write_result(const std::string& path, const std::function<std::string()>& text);

/// Rejects several results that go to stdout. `results`: pairs of an option and its path.
void check_stdout_has_one_use(const std::vector<std::array<std::string, 2>>& results);

}  // namespace rt
