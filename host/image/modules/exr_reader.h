// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture_module.h"

namespace rt::module {

/// Reads the first part of an OpenEXR file as floats, color channels first. Returns 0 when the sink
/// stopped it; throws std::exception for any error in the file.
int decode_exr(const char* path, const PictureSink& sink);

}  // namespace rt::module
