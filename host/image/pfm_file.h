// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/image/input_file.h"
#include "host/image/picture.h"

namespace rt {

/// Writes the picture as a Portable Float Map: "PF" (3 channels) or "Pf" (1 channel), little-endian
/// 32-bit floats, bottom row first; every bit of every float is kept. The format cannot hold
/// metadata. Needs almost no memory. Other channel counts throw Error(ExitCode::output).
void write_pfm(const std::string& path, const Picture& picture);

/// Reads a Portable Float Map of either byte order. The magnitude of the scale in its header is
/// a unit of measure and does not change the values. Throws Error(ExitCode::input).
Picture read_pfm(const std::string& path, InputFile file);

}  // namespace rt
