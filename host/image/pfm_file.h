// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/image/picture.h"

namespace rt {

/// The picture as a Portable Float Map: "PF" (3 channels) or "Pf" (1 channel), little-endian
/// 32-bit floats, bottom row first; every bit of every float is kept. The format has no place for
/// metadata. Other channel counts throw Error(ExitCode::output) naming `path`.
std::vector<std::byte> encode_pfm(const std::string& path, const Picture& picture);

/// Reads a Portable Float Map of either byte order. The magnitude of the scale in its header is
/// a unit of measure and does not change the values. Throws Error(ExitCode::input).
Picture read_pfm(const std::string& path);

}  // namespace rt
