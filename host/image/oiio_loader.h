// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/error.h"
#include "host/image/oiio_module.h"

namespace rt {

/// The image library, loaded on the first call, which takes 150 ms; while it loads, no thread can
/// be started, so not while rays are timed. It is libmirrorball_oiio.so, looked for
/// 1. in the directory of the executable,
/// 2. in the directories of MIRRORBALL_MODULE_DIR, a list separated by colons fixed when the
///    program was built; a relative one starts at the directory of the executable.
/// Throws Error(failure) naming the missing file.
const oiio::Module& image_library(ExitCode failure);

}  // namespace rt
