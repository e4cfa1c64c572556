// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture_module.h"

namespace rt::module {

/// Writes the picture as OpenEXR: 32-bit float, zip, no date. Returns 0 when the sink stopped it;
/// throws std::exception for any error in the library.
int encode_exr(const EncodeRequest& request, const ByteSink& sink);

}  // namespace rt::module
