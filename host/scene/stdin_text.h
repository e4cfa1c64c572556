// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/text_file.h"

namespace rt {

/// Reads standard input to its end and puts a copy in its place that can be read again and again,
/// by this process and by those it starts. Done once, by whoever comes first. Throws Error:
/// ExitCode::input when it cannot be read, ExitCode::limit when it is too large for a scene.
void keep_stdin();

/// All that came by standard input. Throws like keep_stdin.
FileText read_stdin();

}  // namespace rt
