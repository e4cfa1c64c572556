// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace rt {

/// The whole of a regular file. Throws Error, with "path: what is wrong; what to do":
/// ExitCode::input when it is missing, unreadable or not a regular file (a pipe or a device never
/// hangs the program), ExitCode::limit when it is larger than `max_bytes`.
std::string read_text_file(const std::string& path, std::size_t max_bytes);

}  // namespace rt
