// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/text_file.h"

namespace rt {

/// Reads standard input to its end and replaces it with a copy that this process and its children
/// can reread. Later calls do nothing. Throws Error: ExitCode::input when it cannot be read,
/// ExitCode::limit when it is too large for a scene.
void keep_stdin();

/// All of standard input. Throws like keep_stdin.
FileText read_stdin();

}  // namespace rt
