// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/image/picture_format.h"
#include "host/options/command_line.h"

namespace rt {

/// Adds -o, with the given help, and --format, the format of "-".
void add_picture_output(const CommandLine& verb, std::string& output,
                        std::optional<PictureFormat>& format, const std::string& help);

/// Sets the format of standard output. Throws Error (ExitCode::usage) if it is a terminal, and if
/// --format is given for a file, whose extension sets its format.
void settle_picture_output(const std::string& output, std::optional<PictureFormat>& format);

}  // namespace rt
