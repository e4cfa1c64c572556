// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/error.h"
#include "host/image/oiio_module.h"

namespace rt {

/// Starts loading the image library on a thread of its own, so that the 150 ms it takes pass
/// while something else is computed. Safe from any thread, any number of times. A failure is
/// kept to itself until a picture is really read or written.
void preload_image_library();

/// The image library, loaded now if it was not before. It is libmirrorball_oiio.so, looked for
/// 1. in the directory of the executable,
/// 2. in the directories of MIRRORBALL_MODULE_DIR, a list separated by colons fixed when the
///    program was built; a relative one starts at the directory of the executable.
/// Throws Error(failure) naming the missing file.
const oiio::Module& image_library(ExitCode failure);

}  // namespace rt
