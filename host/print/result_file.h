// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// Refuses, before anything is measured, what write_result could not write or should not: Error
/// (output) for a place that cannot be written, Error (usage) for a file that is there and does
/// not begin as results do with `first_bytes`: "--json scene.json" must not replace a scene.
/// Nothing for "" and "-".
void check_result_path(const std::string& path, const std::string& first_bytes);

/// Writes results to stdout ("-"), to a file, whole or not at all, or nowhere (""). Throws Error
/// (output).
void write_result(const std::string& path, const std::string& text);

}  // namespace rt
