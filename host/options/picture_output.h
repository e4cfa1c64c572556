// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/image/picture_format.h"
#include "host/options/command_line.h"

namespace rt {

/// Adds -o, whose help is given, and --format, which says what "-" is written in.
void add_picture_output(const CommandLine& verb, std::string& output,
                        std::optional<PictureFormat>& format, const std::string& help);

/// Gives standard output its format. Throws Error (ExitCode::usage) for a terminal, and where
/// --format is given for a file, whose ending says its format.
void settle_picture_output(const std::string& output, std::optional<PictureFormat>& format);

}  // namespace rt
