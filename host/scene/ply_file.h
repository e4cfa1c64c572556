// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/scene/line_scanner.h"
#include "host/scene/model.h"

namespace rt {

/// Reads a PLY model (Turk 1994): ascii or binary of either byte order. Elements 'vertex' (x, y,
/// z, and nx, ny, nz), 'face' (vertex_indices or vertex_index) and 'tristrips' make the mesh;
/// others are skipped. Faces that cannot be built are left out with a note. Throws Error,
/// ExitCode::input, if none is left, or if the header or missing bytes leave the mesh unknown.
Model parse_ply(std::string_view text, const std::string& file_name, const ReadPace& pace = {});

}  // namespace rt
