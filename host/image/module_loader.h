// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/base/error.h"
#include "host/image/picture_format.h"
#include "host/image/picture_module.h"

namespace rt {

/// The module that reads and writes the format, loaded on the first call: OpenEXR's takes a
/// millisecond or two, OpenImageIO's, with 260 libraries, 150 and more. Only for formats that need
/// one (needs_module). The first caller loads it; others wait. Throws Error(failure) naming the
/// missing file.
const PictureModule& picture_module(PictureFormat format, ExitCode failure);

}  // namespace rt
