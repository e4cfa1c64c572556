// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture_module.h"

namespace rt {

/// Writes OpenEXR: 32-bit float, zip, no date.
std::vector<std::byte> encode_exr(const EncodeRequest& request);

/// Reads the first part of an OpenEXR file as floats, color channels first.
PictureFile decode_exr(const std::string& path, const char* format, const CheckSize& check);

}  // namespace rt
